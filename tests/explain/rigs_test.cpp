// Data sets of catheters and tendons: read, made again by the engine's kinematics, and refused where they are wrong.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <sstream>

#include "core/errors.h"
#include "explain/beat_clock.h"
#include "explain/folder.h"
#include "explain/rig.h"
#include "explain/tracer.h"

using namespace cathlab;
using explain_test::Folder;

namespace {

constexpr double pi = 3.14159265358979323846;

const std::string head =
    "format = 1\ntitle = \"t\"\nsource = \"s\"\nlicense = \"l\"\ndeclared_effects = []\nsensor_noise = 0.0\n";
const std::string catheter_setup =
    "kind = \"catheter-tip\"\n[setup]\nproximal_length_mm = 25\nmiddle_length_mm = 4\ndistal_length_mm = 30\n"
    "tip_length_mm = 2\nbase_position_mm = [10, 20, 30]\nbase_axis = [0, 1, 0]\nbend_plane_axis = [0, 0, 1]\n";
const std::string catheter_header =
    "run,t_s,insertion_mm,rotation_deg,proximal_bend_deg,distal_bend_deg,tip_x_mm,tip_y_mm,tip_z_mm\n";
const std::string tendon_setup =
    "kind = \"tendon-tip\"\n[setup]\ntendon_radius_mm = 4\n[[setup.segment]]\nname = \"one\"\nlength_mm = 60\n"
    "tendons = [\"a_mm\", \"b_mm\", \"c_mm\"]\n";

std::string error_of(const std::function<void()>& act) {
    try {
        act();
    } catch (const UserError& e) {
        return e.what();
    }
    return "";
}

/// Pulls of one segment of three tendons whose first sits at `first_deg`, and where the tip then is.
std::string tendon_rows(double first_deg, double gain) {
    std::ostringstream csv;
    csv.precision(12);
    csv << "run,t_s,a_mm,b_mm,c_mm,tip_x_mm,tip_y_mm,tip_z_mm\n";
    for (int i = 0; i < 240; ++i) {
        const double angle = 0.37 * i, bend = 0.15 + 0.5 * std::fabs(std::sin(0.05 * i));
        csv << i / 60 << "," << 0.5 * i;
        for (int k = 0; k < 3; ++k)
            csv << "," << 4.0 * bend / gain * std::cos(angle - first_deg * pi / 180.0 - 2.0 * pi * k / 3.0);
        const double out = 60.0 * (1.0 - std::cos(bend)) / bend;
        csv << "," << out * std::cos(angle) << "," << out * std::sin(angle) << "," << 60.0 * std::sin(bend) / bend
            << "\n";
    }
    return csv.str();
}

}  // namespace

TEST(CatheterRig, TwoArcsLinkAndTipInTheFrameOfTheBase) {
    std::string csv = catheter_header;
    // A quarter turn of the distal segment alone, the base turned by a quarter: the tip goes towards +x of the world
    // (base: z = world y, x = world z, y = world x).
    const double r = 30.0 / (pi / 2.0);
    for (int i = 0; i < 40; ++i) {
        std::ostringstream row;
        row.precision(12);
        row << i / 20 << "," << i % 20 << ",5,90,0,90," << 10.0 + r + 2.0 << "," << 20.0 + 5.0 + 25.0 + 4.0 + r << ","
            << 30.0 << "\n";
        csv += row.str();
    }
    const Folder folder(head + catheter_setup, csv);
    const Dataset data = read_dataset(folder.path());
    const Split split = split_rows(data);
    for (const auto& column : make_rig(data, split)->residual({}, {}))
        for (const double left : column) EXPECT_NEAR(left, 0.0, 1e-9);
}

TEST(TendonRig, FindsAngleAndGainOfTheTendons) {
    const Folder folder(head + tendon_setup, tendon_rows(70.0, 0.8));
    ExplainOptions options;
    options.max_effects = 0;
    const Explanation found = explain(read_dataset(folder.path()), options);
    EXPECT_LT(found.held_out_before, 1e-3);
    for (const auto& [name, value] : found.base_parameters) {
        if (name == "one_first_tendon_deg") {
            EXPECT_NEAR(std::remainder(value - 70.0, 360.0), 0.0, 0.05);
        }
        if (name == "one_gain") {
            EXPECT_NEAR(value, 0.8, 1e-3);
        }
        if (name == "marker_z_mm") {
            EXPECT_NEAR(value, 0.0, 0.01);
        }
    }
}

TEST(Inputs, AMissingInputStaysAsItWasAndItsRowIsNotMeasured) {
    std::string csv = catheter_header;
    for (int i = 0; i < 20; ++i) csv += "0," + std::to_string(i) + (i == 7 ? ",,0,0,0,1,2,3\n" : ",5,0,0,0,1,2,3\n");
    const Folder folder(head + catheter_setup, csv);
    const Dataset data = read_dataset(folder.path());
    EXPECT_EQ(data.find("insertion")->values[7], 5.0);
    EXPECT_TRUE(std::isnan(data.find("tip_x")->values[7]));
    EXPECT_EQ(data.find("tip_x")->values[8], 1.0);
}

TEST(Runs, ThatAreInterleavedAreJoined) {
    std::string csv = catheter_header;
    for (int i = 0; i < 20; ++i)
        csv +=
            std::string(i % 2 == 0 ? "a" : "b") + "," + std::to_string(i) + "," + std::to_string(i) + ",0,0,0,1,2,3\n";
    const Folder folder(head + catheter_setup, csv);
    const Dataset data = read_dataset(folder.path());
    EXPECT_EQ(data.run[9], 0);
    EXPECT_EQ(data.run[10], 1);
    EXPECT_EQ(data.find("insertion")->values[10], 1.0);
}

TEST(Refused, WhatASetupLacksIsNamed) {
    std::string csv = catheter_header;
    for (int i = 0; i < 20; ++i) csv += "0," + std::to_string(i) + ",5,0,0,0,1,2,3\n";
    const auto reading = [&](const std::string& setup, const std::string& rows) {
        const Folder folder(head + setup, rows);
        return error_of([&] { read_dataset(folder.path()); });
    };
    std::string skewed = catheter_setup;
    skewed.replace(skewed.find("[0, 0, 1]"), 9, "[0, 1, 1]");
    EXPECT_NE(reading(skewed, csv).find("is not square to base_axis"), std::string::npos);
    std::string negative = catheter_setup;
    negative.replace(negative.find("= 25"), 4, "= -5");
    EXPECT_NE(reading(negative, csv).find("above 0 is wanted"), std::string::npos);
    EXPECT_NE(reading("kind = \"catheter-tip\"\n[setup]\n", csv).find("proximal_length_mm"), std::string::npos);
    std::string other = tendon_setup;
    other.replace(other.find("c_mm"), 4, "d_mm");
    const std::string said = reading(other, tendon_rows(0.0, 1.0));
    EXPECT_NE(said.find("data.csv has no column 'd_mm'"), std::string::npos) << said;
    std::string twice = tendon_setup;
    twice.replace(twice.find("c_mm"), 4, "a_mm");
    EXPECT_NE(reading(twice, tendon_rows(0.0, 1.0)).find("named twice"), std::string::npos);
}

TEST(Odd, ConstantInputsAColumnOfZerosAndASingleRunGiveAnHonestAnswer) {
    std::string csv = catheter_header;
    for (int i = 0; i < 60; ++i) csv += "0," + std::to_string(i) + ",5,0,0,0,0,0,0\n";
    const Folder folder(head + catheter_setup, csv);
    const Explanation found = explain(read_dataset(folder.path()));
    for (const FittedEffect& effect : found.effects)
        for (const auto& [key, value] : effect.parameters) EXPECT_TRUE(std::isfinite(value)) << effect.name << key;
    std::string still = "run,t_s,a_mm,b_mm,c_mm,tip_x_mm,tip_y_mm,tip_z_mm\n";
    for (int i = 0; i < 60; ++i) still += "0," + std::to_string(i) + ",0,0,0,1,2,60\n";
    const Folder unmoved(head + tendon_setup, still);
    EXPECT_NE(error_of([&] { explain(read_dataset(unmoved.path())); }).find("no tendon was ever pulled"),
              std::string::npos);
}

TEST(Beats, EarlyOnesAndThePausesAfterThemAreNoFalseTriggers) {
    std::vector<double> beats{0.0};
    for (int k = 1; k < 31; ++k) beats.push_back(beats.back() + 0.87 * (k % 7 == 4 ? 0.62 : (k % 7 == 5 ? 1.38 : 1.0)));
    EXPECT_EQ(beats_among(beats), beats);
}

TEST(Beats, ATriggerBetweenTwoOfARhythmIsLeftOut) {
    std::vector<double> beats;
    for (int k = 0; k < 20; ++k) beats.push_back(0.65 * k);
    std::vector<double> triggers = beats;
    for (const int k : {3, 8, 15}) triggers.push_back(0.65 * k + 0.17);
    std::sort(triggers.begin(), triggers.end());
    EXPECT_EQ(beats_among(triggers), beats);
}

TEST(Tension, WhatTakesTimeIsNotTriedWhereOneRateSaysNothingOfIt) {
    const std::string setup =
        "kind = \"wall-tension\"\n[setup]\nspecimen = \"s\"\nthickness_mm = 2.0\nmode = \"tension\"\n";
    const auto refused = [&](double back_from_s) {
        std::ostringstream csv;
        csv.precision(9);
        csv << "run,t_s,stress_kpa,strain\n";
        for (int run = 0; run < 2; ++run)
            for (int i = 0; i < 40; ++i) {
                const double t = 0.5 * i, strain = 0.01 * (t < back_from_s ? t : 2.0 * back_from_s - t);
                csv << run << "," << t << "," << 80.0 * strain * (1.0 + strain) << "," << strain << "\n";
            }
        const Folder folder(head + setup, csv.str());
        ExplainOptions options;
        options.max_effects = 0;
        const Explanation found = explain(read_dataset(folder.path()), options);
        for (const Candidate& c : found.candidates)
            if (c.name == "viscoelasticity") return c.refused_because;
        return std::string("is no candidate");
    };
    EXPECT_NE(refused(100.0).find("at one rate"), std::string::npos) << refused(100.0);
    EXPECT_EQ(refused(12.0).find("at one rate"), std::string::npos);
}
