// What an operator may ask for, sensible or not, and what the channels tell of it.
#include <array>
#include <cmath>
#include <limits>

#include "contrast/transport.h"
#include "core/units.h"
#include "scene/temporary_folder.h"
#include "step/rig.h"

namespace cathlab {
namespace {

class NonsenseFrom : public testing::TestWithParam<double> {};

TEST_P(NonsenseFrom, EveryActionIsClampedAndTold) {
    SceneSpec spec = rig_spec("fork");
    for (const ActionInfo& action : action_table()) {
        RigRun run(spec, "fork");
        Input input;
        input.*action.value = GetParam();
        run.step(input, 3);
        EXPECT_TRUE(run.finite()) << action.name;
        EXPECT_GE(run.count_events("clamped"), 3) << action.name;
    }
}

INSTANTIATE_TEST_SUITE_P(Numbers, NonsenseFrom,
                         testing::Values(std::numeric_limits<double>::quiet_NaN(),
                                         std::numeric_limits<double>::infinity(),
                                         -std::numeric_limits<double>::infinity(), 1e9, -1e9));

TEST(Nonsense, OnEveryActionForASecondLeavesAFiniteState) {
    RigRun run("fork");
    const std::array<double, 5> values{std::numeric_limits<double>::quiet_NaN(),
                                       std::numeric_limits<double>::infinity(), 1e9,
                                       -std::numeric_limits<double>::infinity(), -1e9};
    for (int k = 0; k < 50; ++k) {
        Input input;
        for (std::size_t a = 0; a < action_table().size(); ++a)
            input.*action_table()[a].value = values[(static_cast<std::size_t>(k) / 7 + a) % values.size()];
        run.step(input);
        ASSERT_TRUE(run.finite()) << k;
    }
}

TEST(Wire, NeverInsertedOrWhollyWithdrawnIsNoFault) {
    SceneSpec spec = rig_spec("tube_wire");
    spec.wire.insertion_mm = 0.0;
    RigRun never(spec, "tube_wire");
    never.step({}, 10);
    EXPECT_TRUE(never.finite());
    const double least = never.channels.wire_insertion_mm;  // one link stands out of the sheath
    never.step(push(50.0), 50);
    EXPECT_NEAR(never.channels.wire_insertion_mm, least + 50.0, 1e-9);

    RigRun out("tube_wire");
    out.step(push(-100.0), 50);
    EXPECT_TRUE(out.finite());
    EXPECT_GE(out.channels.wire_insertion_mm, 0.0);
    EXPECT_LT(out.channels.wire_insertion_mm, 6.0);
    out.step(push(50.0), 20);
    EXPECT_TRUE(out.finite());
}

TEST(Catheter, NeverInsertedOrWhollyWithdrawnIsNoFault) {
    SceneSpec spec = rig_spec("tube_catheter");
    spec.catheter.insertion_mm = 0.0;
    RigRun never(spec, "tube_catheter");
    never.step({}, 10);
    EXPECT_TRUE(never.finite());
    EXPECT_EQ(never.channels.catheter_insertion_mm, 0.0);

    RigRun out("tube_catheter");
    out.step(push(-100.0, 1.0), 50);
    EXPECT_TRUE(out.finite());
    EXPECT_EQ(out.channels.catheter_insertion_mm, 0.0);
}

TEST(Fork, BothDevicesWithdrawnTogetherAreNoFault) {
    RigRun run("fork");
    for (int k = 0; k < 120; ++k) run.step(push(-100.0, k % 2 == 0 ? 0.0 : 1.0));
    EXPECT_TRUE(run.finite());
    EXPECT_EQ(run.channels.catheter_insertion_mm, 0.0);
}

TEST(Channels, TimeAndInsertionFollowTheOperator) {
    RigRun run("tube_wire");
    run.step(push(10.0), 25);
    EXPECT_DOUBLE_EQ(run.channels.time_s, 0.5);
    EXPECT_NEAR(run.channels.wire_insertion_mm, 85.0, 1e-9);
    Input turn;
    turn.rotate = 90.0;
    run.step(turn, 50);
    EXPECT_NEAR(run.channels.wire_rotation_deg, 90.0, 1e-6);
    EXPECT_LT(run.channels.wire_refused_mm, 1e-9);
}

TEST(Channels, OnlyTheSelectedDeviceMoves) {
    RigRun run("fork");
    run.step(push(10.0, 1.0), 25);
    EXPECT_NEAR(run.channels.wire_insertion_mm, 50.0, 1e-9);
    EXPECT_NEAR(run.channels.catheter_insertion_mm, 10.0, 0.1);
    run.step(push(10.0, 0.0), 25);
    EXPECT_NEAR(run.channels.wire_insertion_mm, 55.0, 1e-6);
    EXPECT_NEAR(run.channels.catheter_insertion_mm, 10.0, 0.1);
}

TEST(Channels, BendsAreTakenAsAsked) {
    RigRun run("tube_catheter");
    Input input;
    input.distal_bend = 10.0;
    run.step(input, 50);
    EXPECT_NEAR(run.channels.catheter_distal_bend_deg, 10.0, 1e-6);
    EXPECT_NEAR(run.channels.catheter_proximal_bend_deg, 0.0, 1e-6);
}

TEST(Channels, OfThreeSegmentsTheLastIsDistalOrAsTheFileSays) {
    const auto device = [](const std::string& middle, const std::string& last) {
        std::string text = "schema = 1\nkind = \"catheter\"\nname = \"three\"\nlink_length_mm = 2.0\n";
        const std::string by[] = {"", middle, last};
        for (int i = 0; i < 3; ++i) {
            text += "[[segments]]\nname = \"s" + std::to_string(i) + "\"\nlength_mm = 12.0\nmax_rate_deg_s = 60.0\n";
            text += "max_bend_deg = " + std::to_string(20 + 10 * i) + ".0\n";
            if (!by[i].empty()) text += "driven_by = \"" + by[i] + "\"\n";
        }
        return text;
    };
    const TemporaryFolder folder;
    struct Case {
        std::string middle, last;
        std::array<double, 3> bend_deg;
    };
    for (const Case& c : {Case{"", "", {10.0, 0.0, 35.0}}, Case{"distal", "", {10.0, 30.0, 35.0}},
                          Case{"proximal", "none", {10.0, 10.0, 0.0}}}) {
        SceneSpec spec = rig_spec("tube_catheter");
        spec.catheter.device = folder.write("three.toml", device(c.middle, c.last));
        RigRun run(spec, "tube_catheter");
        Input input;
        input.proximal_bend = 10.0;
        input.distal_bend = 35.0;
        run.step(input, 100);
        for (std::size_t i = 0; i < 3; ++i)
            EXPECT_NEAR(run.parts.catheter_state->bend_rad[i] / units::deg, c.bend_deg[i], 0.1)
                << i << c.middle << c.last;
        EXPECT_NEAR(run.channels.catheter_proximal_bend_deg, 10.0, 0.1);
        EXPECT_NEAR(run.channels.catheter_distal_bend_deg, c.last == "none" ? 0.0 : 35.0, 0.1);
    }
    SceneSpec spec = rig_spec("tube_catheter");
    spec.catheter.device = folder.write("three.toml", device("sideways", ""));
    EXPECT_THROW(build_world(spec, rig_models("tube_catheter"), 1, 1), UserError);
}

TEST(Channels, TheBeamCountsPedalTimeAndDoseGrowsOnlyThen) {
    RigRun run("tube_wire");
    Input input;
    input.primary_angle = 20.0;
    input.secondary_angle = -10.0;
    run.step(input, 250);
    EXPECT_NEAR(run.channels.primary_angle_deg, 20.0, 1e-9);
    EXPECT_NEAR(run.channels.secondary_angle_deg, -10.0, 1e-9);
    EXPECT_EQ(run.channels.beam_time_s, 0.0);
    EXPECT_EQ(run.channels.air_kerma_mgy, 0.0);
    input.fluoroscopy = 1.0;
    run.step(input, 50);
    EXPECT_EQ(run.channels.beam_on, 1.0);
    EXPECT_NEAR(run.channels.beam_time_s, 1.0, 1e-9);
    const double dose = run.channels.air_kerma_mgy;
    EXPECT_GT(dose, 0.0);
    EXPECT_GT(run.channels.dose_area_product_gycm2, 0.0);
    input.fluoroscopy = 0.0;
    run.step(input, 50);
    EXPECT_EQ(run.channels.beam_on, 0.0);
    EXPECT_NEAR(run.channels.beam_time_s, 1.0, 1e-9);
    EXPECT_EQ(run.channels.air_kerma_mgy, dose);
}

TEST(Channels, EveryMilligramOfContrastIsInTheTreeOrWashedOut) {
    RigRun run("fork");
    Input input;
    input.contrast = 5.0;
    run.step(input, 50);
    input.contrast = 0.0;
    run.step(input, 50);
    EXPECT_NEAR(run.channels.contrast_injected_ml, 5.0, 1e-9);
    const ContrastState& bolus = *run.parts.contrast_state;
    EXPECT_NEAR(bolus.injected_mg, 5.0 * 320.0, 1e-6);
    EXPECT_NEAR(iodine_in_tree_mg(*run.parts.contrast, bolus) + bolus.washed_out_mg, bolus.injected_mg, 1e-6);
}

TEST(ForceBar, IsOverItsLimitOnlyWhereATipTouches) {
    RigRun run("tube_wire");
    run.step(push(20.0), 50);
    EXPECT_EQ(run.channels.force_bar_n, 0.0) << "nothing is touched yet";
    run.step(push(60.0), 100);
    EXPECT_GT(run.channels.force_bar_n, 0.0);
    EXPECT_DOUBLE_EQ(run.channels.force_bar, run.channels.force_bar_n / run.channels.force_limit_n);
    EXPECT_DOUBLE_EQ(run.channels.force_limit_n, 0.8);
}

}  // namespace
}  // namespace cathlab
