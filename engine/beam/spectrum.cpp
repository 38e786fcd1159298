#include "beam/spectrum.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "beam/materials.h"
#include "core/check.h"
#include "core/deterministic_math.h"

namespace cathlab {
namespace {

constexpr double first_kev = 20.5;  // below it nothing leaves the filters
constexpr double joule_per_kev = 1.602176634e-16;

// What the exposure control asks for at every pulse, once for each whole keV.
struct Coefficients {
    double water, aluminium, copper, caesium_iodide;  // 1/mm
    double air;                                       // energy absorption, cm2/g
};

Coefficients coefficients_at(double energy_kev, TableReading way) {
    const auto of = [&](const char* name) { return attenuation_per_mm(material(name), energy_kev, way); };
    return {of("water"), of("aluminium"), of("copper"), of("caesium_iodide"), air_energy_absorption_cm2_g(energy_kev)};
}

std::vector<Coefficients> whole_energies(TableReading way) {
    std::vector<Coefficients> out;
    for (double e = first_kev; e < 150.0; e += 1.0) out.push_back(coefficients_at(e, way));
    return out;
}

Coefficients coefficients(double energy_kev, TableReading way) {
    static const std::vector<Coefficients> cubic = whole_energies(TableReading::cubic);
    static const std::vector<Coefficients> straight = whole_energies(TableReading::straight);
    const std::vector<Coefficients>& table = way == TableReading::cubic ? cubic : straight;
    const double place = energy_kev - first_kev;
    const auto k = static_cast<std::size_t>(std::max(0.0, place));
    return place == static_cast<double>(k) && k < table.size() ? table[k] : coefficients_at(energy_kev, way);
}

double water_per_mm(double energy_kev) {
    static const Material& water = material("water");
    return attenuation_per_mm(water, energy_kev);
}

// Sum of weights behind a slab of water.
double behind(const FineSpectrum& s, const std::vector<double>& weight, std::size_t begin, std::size_t end,
              double water_mm) {
    double sum = 0.0;
    for (std::size_t i = begin; i < end; ++i)
        sum += water_mm > 0.0 ? weight[i] * det::exp(-s.water_per_mm[i] * water_mm) : weight[i];
    return sum;
}

double energy_of_water_attenuation(double per_mm, double low, double high) {
    for (int i = 0; i < 60; ++i) {
        const double middle = 0.5 * (low + high);
        (water_per_mm(middle) > per_mm ? low : high) = middle;
    }
    return 0.5 * (low + high);
}

std::vector<double> kerma_weights(const FineSpectrum& s) {
    std::vector<double> out;
    for (std::size_t i = 0; i < s.photons.size(); ++i) out.push_back(s.photons[i] * s.energy_kev[i] * s.air_cm2_g[i]);
    return out;
}

}  // namespace

FineSpectrum fine_spectrum(const SpectrumSpec& spec, TableReading way) {
    CATHLAB_CHECK(spec.kvp >= 40.0 && spec.kvp <= 150.0, "tube voltage 40 to 150 kV");
    FineSpectrum out;
    double photons = 0.0, signal = 0.0, kerma = 0.0;
    // Steps of 1 keV; the last one is cut at the peak, so that the spectrum changes smoothly with the voltage.
    for (double e = first_kev; e - 0.5 < spec.kvp; e += 1.0) {
        const double top = std::min(e + 0.5, spec.kvp);
        const double width = top - (e - 0.5);
        const double middle = 0.5 * (top + e - 0.5);
        const Coefficients mu = coefficients(middle, way);
        const double n = width * (spec.kvp / middle - 1.0) *
                         det::exp(-mu.aluminium * spec.aluminium_mm - mu.copper * spec.copper_mm);
        const double absorbed = 1.0 - det::exp(-mu.caesium_iodide * spec.caesium_iodide_mm);
        out.water_per_mm.push_back(mu.water);
        out.air_cm2_g.push_back(mu.air);
        out.energy_kev.push_back(middle);
        out.photons.push_back(n);
        out.signal.push_back(n * middle * absorbed);
        photons += n;
        signal += out.signal.back();
        kerma += n * middle * mu.air;
    }
    out.total = photons;
    for (double& n : out.photons) n /= photons;
    for (double& s : out.signal) s /= signal;
    // keV cm2/g per photon -> nGy mm2: 100 mm2/cm2, 1000 g/kg, 1e9 nGy/Gy.
    out.kerma_per_photon = kerma / photons * joule_per_kev * 100.0 * 1000.0 * 1e9;
    return out;
}

std::vector<SpectrumBin> spectrum_bins(const FineSpectrum& s, int count) {
    CATHLAB_CHECK(count >= 2 && count <= 16, "2 to 16 bins");
    const std::size_t n = s.energy_kev.size();
    std::vector<double> hardened(n);
    for (std::size_t i = 0; i < n; ++i) hardened[i] = behind(s, s.signal, i, i + 1, 100.0);
    const auto part = [&](std::size_t begin, std::size_t end) {
        double sum = 0.0;
        for (std::size_t i = begin; i < end; ++i) sum += hardened[i];
        return sum;
    };
    std::vector<std::size_t> cuts = {0, n};
    for (const double edge_kev : {33.1694, 69.525, 78.3948}) {
        const auto cut = static_cast<std::size_t>(std::lower_bound(s.energy_kev.begin(), s.energy_kev.end(), edge_kev) -
                                                  s.energy_kev.begin());
        // A sliver between an edge and the peak voltage would waste a bin.
        if (cut > 0 && cut < n && part(cut, n) > 0.01 && static_cast<int>(cuts.size()) <= count)
            cuts.insert(cuts.end() - 1, cut);
    }
    while (static_cast<int>(cuts.size()) - 1 < count) {
        std::size_t heaviest = 0;
        for (std::size_t b = 0; b + 1 < cuts.size(); ++b) {
            const bool divisible = cuts[b + 1] - cuts[b] > 1;
            if (divisible && part(cuts[b], cuts[b + 1]) > part(cuts[heaviest], cuts[heaviest + 1])) heaviest = b;
        }
        const double half = 0.5 * part(cuts[heaviest], cuts[heaviest + 1]);
        std::size_t cut = cuts[heaviest] + 1;
        while (cut + 1 < cuts[heaviest + 1] && part(cuts[heaviest], cut) < half) ++cut;
        cuts.insert(cuts.begin() + static_cast<std::ptrdiff_t>(heaviest) + 1, cut);
    }
    std::vector<SpectrumBin> bins;
    for (std::size_t b = 0; b + 1 < cuts.size(); ++b) {
        const double weight = behind(s, s.signal, cuts[b], cuts[b + 1], 0.0);
        const double through = behind(s, s.signal, cuts[b], cuts[b + 1], 200.0);
        const double per_mm = -det::log(through / weight) / 200.0;
        bins.push_back({energy_of_water_attenuation(per_mm, s.energy_kev[cuts[b]], s.energy_kev[cuts[b + 1] - 1]),
                        weight, cuts[b], cuts[b + 1]});
    }
    return bins;
}

std::vector<double> bin_attenuation_per_mm(const FineSpectrum& spectrum, std::span<const SpectrumBin> bins,
                                           const Material& material) {
    const double of_water = mass_attenuation_cm2_g(cathlab::material("water"), 60.0);
    const bool like_water = std::fabs(mass_attenuation_cm2_g(material, 60.0) / of_water - 1.0) < 0.15;
    std::vector<double> out;
    for (const SpectrumBin& bin : bins) {
        std::vector<double> signal, mu;
        double whole = 0.0, mean = 0.0;
        for (std::size_t i = bin.first; i < bin.last; ++i) {
            mu.push_back(attenuation_per_mm(material, spectrum.energy_kev[i]));
            signal.push_back(like_water ? spectrum.signal[i]
                                        : spectrum.signal[i] * det::exp(-200.0 * spectrum.water_per_mm[i]));
            whole += signal.back();
            mean += signal.back() * mu.back();
        }
        const double thickness = like_water ? 200.0 / material.density_g_cm3 : 0.5 * whole / mean;
        double through = 0.0;
        for (std::size_t i = 0; i < mu.size(); ++i) through += signal[i] * det::exp(-mu[i] * thickness);
        out.push_back(-det::log(through / whole) / thickness);
    }
    return out;
}

double kerma_transmission(const FineSpectrum& spectrum, double water_mm) {
    const std::vector<double> weight = kerma_weights(spectrum);
    return behind(spectrum, weight, 0, weight.size(), water_mm) / behind(spectrum, weight, 0, weight.size(), 0.0);
}

double signal_transmission(const FineSpectrum& spectrum, double water_mm) {
    return behind(spectrum, spectrum.signal, 0, spectrum.signal.size(), water_mm);
}

double photons_per_mm2_ngy(const FineSpectrum& spectrum, double water_mm) {
    const double photons = behind(spectrum, spectrum.photons, 0, spectrum.photons.size(), water_mm);
    return photons / (spectrum.kerma_per_photon * kerma_transmission(spectrum, water_mm));
}

}  // namespace cathlab
