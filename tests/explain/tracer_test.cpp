// Recordings made here by formulas of their own: a beat, breathing, a vibration, noise.
#include "explain/tracer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <sstream>

#include "core/errors.h"
#include "core/random.h"
#include "explain/beat_clock.h"
#include "explain/folder.h"

using namespace cathlab;
using explain_test::Folder;
using explain_test::heart_toml;

namespace {

constexpr double pi = std::numbers::pi;

double beat(double phase) {
    return 4.0 * std::cos(2.0 * pi * phase) + 1.5 * std::sin(4.0 * pi * phase) - 0.7 * std::cos(6.0 * pi * phase);
}

/// Two runs of 40 s at 20 Hz with beats of 0.83 s; `more` adds to the displacement.
Folder heart(std::uint64_t seed, double noise, const std::function<double(double)>& more) {
    std::ostringstream csv, beats;
    csv.precision(9);
    csv << "run,t_s,displacement_mm\n";
    beats << "[";
    for (int run = 0; run < 2; ++run) {
        beats << (run > 0 ? ", [" : "[");
        for (int b = 0; b < 50; ++b) beats << (b > 0 ? ", " : "") << 0.83 * b;
        beats << "]";
        for (int i = 0; i < 800; ++i) {
            const double t = 0.05 * i;
            const double phase = t / 0.83 - std::floor(t / 0.83);
            const double error = noise * random_normal(seed, RandomStream::test, static_cast<std::uint64_t>(run),
                                                       static_cast<std::uint64_t>(i));
            csv << run << "," << t << "," << 10.0 * run + beat(phase) + more(t) + error << "\n";
        }
    }
    beats << "]";
    return Folder(heart_toml(beats.str(), std::to_string(noise)), csv.str());
}

}  // namespace

TEST(BeatPhase, RunsFromBeatToBeat) {
    const std::vector<double> beats{1.0, 2.0, 4.0};
    EXPECT_DOUBLE_EQ(beat_phase(beats, 1.25), 0.25);
    EXPECT_DOUBLE_EQ(beat_phase(beats, 3.0), 0.5);
    EXPECT_TRUE(std::isnan(beat_phase(beats, 0.5)));
    EXPECT_TRUE(std::isnan(beat_phase(beats, 4.5)));
}

TEST(Explain, FindsNothingWhereOnlyTheHeartBeats) {
    for (const std::uint64_t seed : {1ULL, 2ULL, 3ULL}) {
        const Folder folder = heart(seed, 0.15, [](double) { return 0.0; });
        const Explanation found = explain(read_dataset(folder.path()));
        EXPECT_EQ(found.verdict, Verdict::nothing_missing) << seed;
        EXPECT_TRUE(found.effects.empty());
        EXPECT_TRUE(found.overlay.empty());
        EXPECT_NEAR(found.held_out_before, 0.15, 0.02);
    }
}

TEST(Explain, NamesTheBreathingThatNobodyDeclared) {
    for (const double amplitude : {1.0, 4.0}) {
        const double period = 3.7;
        const Folder folder = heart(5, 0.15, [&](double t) {
            const double s = std::sin(pi * (t / period + 0.2));
            return -amplitude * s * s * s * s;
        });
        ExplainOptions options;
        options.threads = 3;
        const Explanation found = explain(read_dataset(folder.path()), options);
        ASSERT_EQ(found.effects.size(), 1U) << amplitude;
        EXPECT_EQ(found.effects[0].name, "respiration");
        EXPECT_EQ(found.verdict, Verdict::explained);
        EXPECT_LE(found.held_out_after, 1.15 * 0.15);
        EXPECT_GT(found.held_out_before, 0.3);
        for (const auto& [key, value] : found.effects[0].parameters) {
            if (key != "period_s") continue;
            EXPECT_NEAR(value, period, 0.02);
        }
        EXPECT_NE(found.overlay.find("[effects.respiration]\nenabled = true\n"), std::string::npos);
    }
}

TEST(Explain, FindsInEachRecordingFromWhenOnAStageMovesAndThatItMeetsAStop) {
    // A sine about the place where the stage stood, cut off by its stop; a trace of it in the other column.
    std::ostringstream csv;
    csv << "run,t_s,x_mm,y_mm,z_mm\n";
    constexpr double period = 3.3, begins_s[3] = {1.7, 3.1, 0.6}, stop_mm = 4.5, noise = 0.15;
    for (std::uint64_t run = 0; run < 3; ++run)
        for (std::uint64_t i = 0; i < 330; ++i) {
            const double t = 0.06 * static_cast<double>(i), at = static_cast<double>(run);
            const double z = std::min(stop_mm, 9.0 * std::sin(2.0 * pi * std::max(0.0, t - begins_s[run]) / period));
            const double place[3] = {2.0 * at + 0.04 * z, 1.0 - 0.02 * z, z - 5.0 * at};
            csv << run << "," << t;
            for (std::uint64_t k = 0; k < 3; ++k)
                csv << "," << place[k] + noise * random_normal(1, RandomStream::test, k, 330 * run + i);
            csv << "\n";
        }
    const Folder folder(heart_toml("[]", "0.15"), csv.str());
    ExplainOptions options;
    options.max_effects = 1;
    options.threads = 3;
    const Explanation found = explain(read_dataset(folder.path()), options);
    ASSERT_EQ(found.effects.size(), 1U);
    EXPECT_EQ(found.effects[0].name, "respiration");
    EXPECT_EQ(found.verdict, Verdict::explained);
    EXPECT_LE(found.held_out_after, 1.15 * noise);
    for (int run = 0; run < 3; ++run)
        for (const auto& [key, value] : found.effects[0].of_runs.at(std::to_string(run)))
            if (key == "held_until_s") {
                EXPECT_NEAR(value, begins_s[run], 0.05) << run;
            }
}

TEST(Explain, GivesTheSameAnswerOnAnyNumberOfThreads) {
    const Folder folder = heart(6, 0.2, [](double t) { return 2.0 * std::pow(std::sin(pi * t / 5.1), 4); });
    const Dataset data = read_dataset(folder.path());
    ExplainOptions options;
    options.max_effects = 1;
    const Explanation one = explain(data, options);
    options.threads = 3;
    const Explanation three = explain(data, options);
    EXPECT_EQ(three.overlay, one.overlay);
    EXPECT_EQ(three.after, one.after);
}

TEST(Explain, LeavesAVibrationUnexplainedButDescribesIt) {
    const Folder folder = heart(7, 0.15, [](double t) { return 0.8 * std::sin(2.0 * pi * t / 0.31); });
    const Explanation found = explain(read_dataset(folder.path()));
    EXPECT_EQ(found.verdict, Verdict::unexplained);
    ASSERT_FALSE(found.left_over.empty());
    EXPECT_EQ(found.left_over[0].what, "oscillation");
    EXPECT_NEAR(found.left_over[0].period_s, 0.31, 0.002);
    EXPECT_NEAR(found.left_over[0].amplitude, 0.8, 0.08);
}

TEST(Explain, FitsTheModulusOfAStraightLine) {
    std::ostringstream csv;
    csv << "run,t_s,stress_mpa,strain\n";
    for (int i = 0; i < 200; ++i)
        csv << 0 << "," << i << "," << 0.001 * i << ","
            << i / 450.0 + 1e-3 * random_normal(1, RandomStream::test, 9, static_cast<std::uint64_t>(i)) << "\n";
    const Folder folder(
        "format = 1\nkind = \"wall-tension\"\ntitle = \"t\"\nsource = \"s\"\nlicense = \"l\"\ndeclared_effects = []\n"
        "sensor_noise = 0.001\n[setup]\nspecimen = \"strip\"\nthickness_mm = 1.0\nmode = \"tension\"\n",
        csv.str());
    const Explanation found = explain(read_dataset(folder.path()));
    ASSERT_EQ(found.base_parameters.size(), 2U);
    EXPECT_EQ(found.base_parameters[0].first, "modulus_kpa");
    EXPECT_NEAR(found.base_parameters[0].second, 450.0, 1.0);
    EXPECT_EQ(found.verdict, Verdict::nothing_missing);
}

TEST(Explain, AToolWhosePlaceIsNotKnownIsToldByItsRow) {
    std::string csv = "run,t_s,tool_x_mm,tool_y_mm,tool_z_mm,sensor_x_mm,sensor_y_mm,sensor_z_mm\n";
    for (int i = 0; i < 40; ++i) csv += "0," + std::to_string(i) + ",,2,30,11,0,50\n";
    const Folder folder(
        "format = 1\nkind = \"wall-contact\"\ntitle = \"t\"\nsource = \"s\"\nlicense = \"l\"\ndeclared_effects = "
        "[]\nsensor_noise = 0.1\n[setup]\ntube = { radius_mm = 10.0, length_mm = 100.0, thickness_mm = 1.0 }\n"
        "tool_radius_mm = 2.0\nsensor_rest_mm = [[11.0, 0.0, 50.0]]\ndensity_kg_m3 = 1000.0\n"
        "material = { young_modulus_kpa = 500.0, poisson = 0.49 }\n"
        "[[setup.fixed]]\nname = \"start\"\ncenter_mm = [0.0, 0.0, 0.0]\nnormal = [0.0, 0.0, 1.0]\n"
        "radius_mm = 12.0\nhalf_thickness_mm = 0.1\n",
        csv);
    const Dataset data = read_dataset(folder.path());
    try {
        explain(data);
        FAIL();
    } catch (const UserError& e) {
        EXPECT_NE(std::string(e.what()).find("the tool's place is missing"), std::string::npos) << e.what();
    }
}
