// The beam in energy bins, and every material's attenuation in each of them.
#pragma once

#include <array>
#include <map>
#include <string>
#include <vector>

#include "beam/spectrum.h"

namespace cathlab {

inline constexpr std::size_t energy_bins = 8;
using BinValues = std::array<float, energy_bins>;

/// Share of each bin in the detector's signal behind the filters, without a patient (sum 1), and mu of the materials.
class BeamTable {
public:
    /// kvp in [40, 150], copper_mm in [0, 1.5]; throws UserError otherwise.
    BeamTable(double kvp, double copper_mm);

    const BinValues& weights() const { return weights_; }
    /// Detected photons per mm2 and nGy of detector kerma behind a patient of 200 mm of water.
    double photons_per_mm2_ngy() const { return photons_; }
    /// Water through which a share `transmission` of the detector's signal gets, mm, 0 to 800: what a patient is worth.
    double water_mm(double transmission) const;
    /// Linear attenuation coefficient in 1/mm per bin; "air" is 0.
    /// Throws UserError with the nearest name for a material that is not in the table.
    BinValues attenuation(const std::string& material) const;
    /// 1/mm per bin for one mg/mL of iodine.
    BinValues iodine() const;

private:
    FineSpectrum spectrum_;
    std::vector<SpectrumBin> bins_;
    BinValues weights_{};
    mutable std::map<std::string, BinValues> known_;  // materials asked for so far: one table serves one thread
    double photons_ = 0;
};

}  // namespace cathlab
