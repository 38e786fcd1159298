// The table and the beam against the library that the table was printed from.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <iterator>

#include "beam/materials.h"
#include "beam/spectrum.h"
#if CATHLAB_HAS_XRAYLIB
#include "beam/xraylib/attenuation_rows.h"
#endif

using namespace cathlab;

#if CATHLAB_HAS_XRAYLIB

namespace {

double truth_cm2_g(const Material& m, double energy_kev) {
    double sum = 0.0;
    for (const MassFraction& part : m.composition)
        sum += part.fraction * xraylib::total(part.atomic_number, energy_kev);
    return sum;
}

double truth_per_mm(const char* name, double energy_kev) {
    return 0.1 * material(name).density_g_cm3 * truth_cm2_g(material(name), energy_kev);
}

}  // namespace

TEST(Xraylib, PrintsTheTableLetterForLetter) {
    std::ifstream file(std::string(CATHLAB_SOURCE_DIR) + "/engine/beam/attenuation_table.inl", std::ios::binary);
    EXPECT_EQ(std::string(std::istreambuf_iterator<char>(file), {}), xraylib::attenuation_table());
}

TEST(Xraylib, EveryMaterialIsWithinATenthOfAPercentBetweenTheTablesEnergies) {
    double worst = 0.0;
    for (const Material& m : material_table()) {
        for (double e = 20.2; e <= 150.0; e += 0.0703) {
            const double error = std::fabs(mass_attenuation_cm2_g(m, e) / truth_cm2_g(m, e) - 1.0);
            EXPECT_LT(error, 1e-3) << m.name << " at " << e;
            worst = std::max(worst, error);
        }
    }
    RecordProperty("worst", std::to_string(worst));
}

TEST(Xraylib, ThePolychromaticSlabIsTheIntegralOfItsOwnCoefficients) {
    // Kramers' law behind 2.5 mm Al and 0.3 mm Cu, energy taken up by 0.55 mm CsI, in steps of 0.05 keV.
    for (const double kvp : {60.0, 80.0, 100.0, 120.0}) {
        const FineSpectrum fine = fine_spectrum({kvp, 2.5, 0.3, 0.55});
        const auto bins = spectrum_bins(fine, 8);
        for (const char* name : {"water", "soft_tissue", "blood"}) {
            const std::vector<double> mu = bin_attenuation_per_mm(fine, bins, material(name));
            for (const double mm : {20.0, 100.0, 250.0}) {
                double open = 0.0, behind = 0.0, few = 0.0;
                for (double e = 20.025; e < kvp; e += 0.05) {
                    const double signal =
                        e * (kvp / e - 1.0) *
                        std::exp(-2.5 * truth_per_mm("aluminium", e) - 0.3 * truth_per_mm("copper", e)) *
                        (1.0 - std::exp(-0.55 * truth_per_mm("caesium_iodide", e)));
                    open += signal;
                    behind += signal * std::exp(-mm * truth_per_mm(name, e));
                }
                for (std::size_t k = 0; k < bins.size(); ++k) few += bins[k].weight * std::exp(-mu[k] * mm);
                EXPECT_NEAR(few / (behind / open), 1.0, 0.005) << kvp << " " << name << " " << mm;
            }
        }
    }
}

#else

TEST(Xraylib, PrintsTheTableLetterForLetter) {
    GTEST_SKIP() << "built without xraylib (libxrl-dev)";
}

#endif
