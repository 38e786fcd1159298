#include "render/attenuation.h"

#include <vector>

#include "beam/materials.h"
#include "beam/spectrum.h"
#include "core/check.h"
#include "core/errors.h"

namespace cathlab {

BeamTable::BeamTable(double kvp, double copper_mm) {
    if (!(kvp >= 40 && kvp <= 150)) throw UserError("tube voltage must lie in [40, 150] kV");
    if (!(copper_mm >= 0 && copper_mm <= 1.5)) throw UserError("copper filter must lie in [0, 1.5] mm");
    SpectrumSpec spec;
    spec.kvp = kvp;
    spec.copper_mm = copper_mm;
    const std::vector<SpectrumBin> bins = spectrum_bins(spec, static_cast<int>(energy_bins));
    CATHLAB_CHECK(!bins.empty() && bins.size() <= energy_bins, "the beam's bins do not fit");
    for (std::size_t k = 0; k < energy_bins; ++k) {  // bins that the beam does not use weigh nothing
        energy_kev_[k] = k < bins.size() ? bins[k].energy_kev : bins.back().energy_kev;
        weights_[k] = k < bins.size() ? static_cast<float>(bins[k].weight) : 0.0F;
    }
    photons_ = cathlab::photons_per_mm2_ngy(fine_spectrum(spec), 200.0);
}

BinValues BeamTable::attenuation(const std::string& name) const {
    BinValues mu{};
    if (name == "air") return mu;
    const Material& found = material(name);
    for (std::size_t k = 0; k < energy_bins; ++k) {
        mu[k] = static_cast<float>(attenuation_per_mm(found, energy_kev_[k]));
    }
    return mu;
}

BinValues BeamTable::iodine() const {
    BinValues mu = attenuation("iodine");
    for (float& m : mu) m *= 1e-3F;  // the table's density is 1 g/cm3 = 1000 mg/mL
    return mu;
}

}  // namespace cathlab
