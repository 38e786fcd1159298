// The beam's spectrum, and a few bins of it that stand for the whole.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "beam/materials.h"

namespace cathlab {

struct SpectrumSpec {
    double kvp = 80.0;                ///< peak tube voltage, 40 to 150 kV
    double aluminium_mm = 2.5;        ///< inherent filtration
    double copper_mm = 0.3;           ///< added filtration
    double caesium_iodide_mm = 0.55;  ///< of the detector
};

/// Relative fluence per keV at energies 20.5, 21.5, ... below the peak voltage: Kramers' law for a thick tungsten
/// anode, photons(E) ~ kvp / E - 1 [kramers1923], behind the filters.  Characteristic lines are left out.
struct FineSpectrum {
    std::vector<double> energy_kev;
    std::vector<double> photons;  ///< sums to 1, at the exit of the tube
    std::vector<double> signal;   ///< energy deposited in the detector per such photon without a patient, sums to 1
    std::vector<double> water_per_mm;  ///< attenuation of water at those energies
    std::vector<double> air_cm2_g;     ///< energy absorption of air at those energies
    double total = 0.0;  ///< what `photons` was before it was made to sum to 1; compares tube outputs per mAs
    double kerma_per_photon = 0.0;  ///< air kerma per unit fluence at the tube's exit, nGy mm2
};
FineSpectrum fine_spectrum(const SpectrumSpec& spec, TableReading way = TableReading::cubic);

struct SpectrumBin {
    double energy_kev;
    double weight;            ///< part of the detector's signal without a patient; the weights sum to 1
    std::size_t first, last;  ///< of the fine spectrum's energies: [first, last)
};

/// `count` bins (2 to 16) for I / I0 = sum weight exp(-sum mu(energy) length).  The cuts are the K edges of iodine,
/// tungsten and platinum that the spectrum holds, and medians of the signal behind 100 mm of water; each bin's energy
/// is the one at which water attenuates as the bin does over 200 mm, so that a water slab of 0 and of 200 mm is exact.
std::vector<SpectrumBin> spectrum_bins(const FineSpectrum& spectrum, int count = 8);

/// Attenuation of a material in each bin, 1/mm: that which lets through the part of the bin's signal that the material
/// would, mu = -ln(sum s exp(-mu(E) t) / sum s) / t.  Where the material attenuates as water does (by mass, within 15 %
/// at 60 keV), it is what patients are made of: t is 20 g/cm2 of it in the open beam.  Any other is seen within a
/// patient: s is the signal behind 200 mm of water, and t what lets e^-1/2 of it through.
std::vector<double> bin_attenuation_per_mm(const FineSpectrum& spectrum, std::span<const SpectrumBin> bins,
                                           const Material& material);

/// Part of the air kerma, and of the detector's signal, that gets through water_mm of water (narrow beam).
double kerma_transmission(const FineSpectrum& spectrum, double water_mm);
double signal_transmission(const FineSpectrum& spectrum, double water_mm);

/// Photons per mm2 and nGy of air kerma behind water_mm of water: what sets the quantum noise.
double photons_per_mm2_ngy(const FineSpectrum& spectrum, double water_mm);

}  // namespace cathlab
