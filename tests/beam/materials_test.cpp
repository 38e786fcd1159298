#include "beam/materials.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "beam/spectrum.h"
#include "core/errors.h"

using namespace cathlab;

TEST(Materials, CompositionsSumToOneAndNamesAreUnique) {
    std::set<std::string_view> names;
    for (const Material& m : material_table()) {
        double sum = 0.0;
        for (const MassFraction& part : m.composition) sum += part.fraction;
        EXPECT_NEAR(sum, 1.0, 2e-4) << m.name;
        EXPECT_TRUE(names.insert(m.name).second) << m.name;
        for (const double e : {20.0, 33.2, 69.6, 150.0}) EXPECT_GT(attenuation_per_mm(m, e), 0.0) << m.name;
    }
}

TEST(Materials, LinearAttenuationIsThatOfTheTables) {
    // 1/cm at 50, 60, 80, 100 keV, XCOM class data.
    struct Row {
        const char* name;
        double mu[4];
    };
    for (const Row& row :
         {Row{"water", {.2269, .2059, .1837, .1707}}, Row{"soft_tissue", {.2223, .2025, .1813, .1688}},
          Row{"blood", {.2403, .2174, .1934, .1795}}, Row{"cortical_bone", {.767, .574, .411, .344}},
          Row{"nitinol", {12.31, 7.59, 3.77, 2.37}}, Row{"stainless_steel", {16.42, 10.10, 4.97, 3.08}},
          Row{"platinum", {149.2, 93.1, 187.3, 107.1}}, Row{"tungsten", {114.5, 71.5, 150.3, 85.4}},
          Row{"tungsten_polymer", {20.0, 12.6, 26.2, 15.0}}, Row{"barium_polymer", {5.02, 3.17, 1.57, .95}},
          Row{"iodine", {12.32, 7.58, 3.51, 1.94}}, Row{"polymer", {.210, .197, .181, .170}}}) {
        const double energies[4] = {50.0, 60.0, 80.0, 100.0};
        for (int i = 0; i < 4; ++i)
            EXPECT_NEAR(10.0 * attenuation_per_mm(material(row.name), energies[i]) / row.mu[i], 1.0, 0.011)
                << row.name << i;
    }
}

TEST(Materials, EdgesAreSharp) {
    const Material& iodine = material("iodine");
    EXPECT_GT(mass_attenuation_cm2_g(iodine, 33.17), 5.0 * mass_attenuation_cm2_g(iodine, 33.16));
    EXPECT_GT(mass_attenuation_cm2_g(material("platinum"), 78.40),
              3.0 * mass_attenuation_cm2_g(material("platinum"), 78.39));
}

TEST(Materials, AnUnknownNameIsAnsweredWithTheNearest) {
    try {
        material("nitinoll");
        FAIL();
    } catch (const UserError& error) {
        EXPECT_NE(std::string(error.what()).find("did you mean 'nitinol'"), std::string::npos) << error.what();
    }
}

TEST(Materials, StraightLinesBetweenTheEnergiesStayWithinHalfAPercent) {
    for (const Material& m : material_table())
        for (double e = 20.2; e <= 150.0; e += 0.7003)
            EXPECT_NEAR(mass_attenuation_cm2_g(m, e, TableReading::straight) / mass_attenuation_cm2_g(m, e), 1.0, 5e-3)
                << m.name << " at " << e;
}

TEST(Spectrum, PhotonsPerKermaAreThoseOfTheStandardBeams) {
    // Photons per mm2 and uGy of the radiation qualities behind their added aluminium [iec62220-1].  Kramers' law knows
    // neither the anode's own filtration nor its lines, so the beam is a little soft at low voltage.
    struct Row {
        double kvp, added_mm, photons;
    };
    for (const Row& row : {Row{50, 10, 21759}, Row{70, 21, 30174}, Row{90, 30, 32362}, Row{120, 40, 31077}}) {
        const FineSpectrum s = fine_spectrum({row.kvp, 2.5 + row.added_mm, 0.0, 0.55});
        EXPECT_NEAR(1000.0 * photons_per_mm2_ngy(s, 0.0) / row.photons, 1.0, 0.09) << row.kvp;
    }
}

TEST(Spectrum, TheHalfValueLayersOfTheBinsAreThoseOfTheIntegral) {
    const auto layer_mm = [](double from_mm, const auto& transmission) {  // halves what from_mm lets through
        double low = from_mm, high = from_mm + 200.0;
        for (int i = 0; i < 60; ++i) {
            const double middle = 0.5 * (low + high);
            (transmission(middle) > 0.5 * transmission(from_mm) ? low : high) = middle;
        }
        return low - from_mm;
    };
    for (const double kvp : {60.0, 80.0, 100.0, 120.0}) {
        const FineSpectrum fine = fine_spectrum({kvp, 2.5, 0.3, 0.55});
        const auto bins = spectrum_bins(fine, 8);
        const auto integral = [&](double mm) { return signal_transmission(fine, mm); };
        const auto binned = [&](double mm) {
            double sum = 0.0;
            for (const SpectrumBin& bin : bins)
                sum += bin.weight * std::exp(-mm * attenuation_per_mm(material("water"), bin.energy_kev));
            return sum;
        };
        double before = 0.0;
        for (const double from_mm : {0.0, 50.0, 100.0, 150.0}) {
            const double truth = layer_mm(from_mm, integral);
            // The open beam, which no picture is of, is 0.51 % off at 100 kV.
            EXPECT_NEAR(layer_mm(from_mm, binned) / truth, 1.0, from_mm > 0.0 ? 0.005 : 0.006)
                << kvp << " kV behind " << from_mm;
            EXPECT_GT(truth, before);  // the beam hardens
            before = truth;
        }
    }
}

TEST(Spectrum, WaterHardensIt) {
    const FineSpectrum s = fine_spectrum({80.0, 2.5, 0.3, 0.55});
    const Material& water = material("water");
    double sum = 0.0, weighted = 0.0;
    for (std::size_t i = 0; i < s.signal.size(); ++i) {
        const double w = s.signal[i] * std::exp(-200.0 * attenuation_per_mm(water, s.energy_kev[i]));
        sum += w;
        weighted += w * s.energy_kev[i];
    }
    EXPECT_NEAR(weighted / sum, 57.7, 1.5);
    EXPECT_GT(signal_transmission(s, 200.0), signal_transmission(s, 100.0) * signal_transmission(s, 100.0));
}

TEST(Spectrum, AFewBinsStandForAllOfIt) {
    for (const double kvp : {60.0, 80.0, 100.0, 120.0}) {
        const FineSpectrum fine = fine_spectrum({kvp, 2.5, 0.3, 0.55});
        const auto bins = spectrum_bins(fine, 8);
        ASSERT_EQ(bins.size(), 8u);
        double weights = 0.0;
        for (const SpectrumBin& bin : bins) weights += bin.weight;
        EXPECT_NEAR(weights, 1.0, 1e-12);
        const Material& water = material("water");
        const std::vector<double> of_water = bin_attenuation_per_mm(fine, bins, water);
        const auto error = [&](const char* name, double mm, double water_mm) {
            const Material& m = material(name);
            const std::vector<double> mu = bin_attenuation_per_mm(fine, bins, m);
            double few = 0.0, all = 0.0;
            for (std::size_t k = 0; k < bins.size(); ++k)
                few += bins[k].weight * std::exp(-mu[k] * mm - of_water[k] * water_mm);
            for (std::size_t i = 0; i < fine.signal.size(); ++i)
                all += fine.signal[i] * std::exp(-attenuation_per_mm(m, fine.energy_kev[i]) * mm -
                                                 attenuation_per_mm(water, fine.energy_kev[i]) * water_mm);
            return few / all - 1.0;
        };
        // Tissues as slabs of their own.
        for (const char* name : {"water", "soft_tissue", "blood", "adipose"})
            for (const double mm : {10.0, 50.0, 100.0, 150.0, 200.0, 250.0})
                EXPECT_NEAR(error(name, mm, 0.0), 0.0, 0.005) << kvp << " " << name << " " << mm;
        // What lies in a patient of 200 mm of water, against the patient without it.
        struct Inside {
            const char* name;
            double mm, most;
        };
        for (const Inside& part :
             {Inside{"cortical_bone", 10, 0.002}, Inside{"cortical_bone", 40, 0.01}, Inside{"nitinol", 0.46, 0.002},
              Inside{"stainless_steel", 0.89, 0.005}, Inside{"tungsten_polymer", 0.25, 0.002},
              Inside{"platinum", 0.1, 0.01}, Inside{"platinum", 0.25, 0.03}, Inside{"iodine", 0.3, 0.002},
              Inside{"iodine", 1.0, 0.003}, Inside{"iodine", 3.0, 0.03}})
            EXPECT_NEAR(error(part.name, part.mm, 200.0), 0.0, part.most) << kvp << " " << part.name << " " << part.mm;
    }
}
