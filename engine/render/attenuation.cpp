#include "render/attenuation.h"

#include "beam/materials.h"
#include "core/check.h"
#include "core/errors.h"

namespace cathlab {

BeamTable::BeamTable(double kvp, double copper_mm) {
    if (!(kvp >= 40 && kvp <= 150)) throw UserError("tube voltage must lie in [40, 150] kV");
    if (!(copper_mm >= 0 && copper_mm <= 1.5)) throw UserError("copper filter must lie in [0, 1.5] mm");
    SpectrumSpec spec;
    spec.kvp = kvp;
    spec.copper_mm = copper_mm;
    spectrum_ = fine_spectrum(spec);
    bins_ = spectrum_bins(spectrum_, static_cast<int>(energy_bins));
    CATHLAB_CHECK(!bins_.empty() && bins_.size() <= energy_bins, "the beam's bins do not fit");
    // Bins that the beam does not use weigh nothing.
    for (std::size_t k = 0; k < bins_.size(); ++k) weights_[k] = static_cast<float>(bins_[k].weight);
    photons_ = cathlab::photons_per_mm2_ngy(spectrum_, 200.0);
}

BinValues BeamTable::attenuation(const std::string& name) const {
    if (name == "air") return {};
    if (const auto it = known_.find(name); it != known_.end()) return it->second;
    BinValues mu{};
    const std::vector<double> per_mm = bin_attenuation_per_mm(spectrum_, bins_, material(name));
    for (std::size_t k = 0; k < per_mm.size(); ++k) mu[k] = static_cast<float>(per_mm[k]);
    return known_[name] = mu;
}

double BeamTable::water_mm(double transmission) const {
    double low = 0.0, high = 800.0;
    for (int i = 0; i < 30; ++i) {
        const double middle = 0.5 * (low + high);
        (signal_transmission(spectrum_, middle) > transmission ? low : high) = middle;
    }
    return 0.5 * (low + high);
}

BinValues BeamTable::iodine() const {
    BinValues mu = attenuation("iodine");
    for (float& m : mu) m *= 1e-3F;  // the table's density is 1 g/cm3 = 1000 mg/mL
    return mu;
}

}  // namespace cathlab
