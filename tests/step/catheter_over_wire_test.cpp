// A passive catheter over a wire, in a soft fork.
#include <cstdio>

#include "core/units.h"
#include "step/rig.h"

namespace cathlab {
namespace {

void say(const char* what, const RigRun& run) {
    const Channels& c = run.channels;
    std::printf(
        "%-22s wire %.1f mm at (%.1f, %.1f, %.1f), catheter %.1f mm at (%.1f, %.1f, %.1f); %.0f and %.0f mN, %.2f mm "
        "deep\n",
        what, c.wire_insertion_mm, c.wire_tip_x_mm, c.wire_tip_y_mm, c.wire_tip_z_mm, c.catheter_insertion_mm,
        c.catheter_tip_x_mm, c.catheter_tip_y_mm, c.catheter_tip_z_mm, c.wire_force_mn, c.catheter_force_mn,
        std::max(c.wire_penetration_mm, c.catheter_penetration_mm));
}

TEST(CatheterOverWire, FollowsTheWireIntoItsBranchAndStaysThereWhenTheWireIsDrawn) {
    RigRun run("catheter_over_wire");
    Input turn;
    turn.rotate = 180.0;
    run.step(turn, 25);
    run.step(push(40.0), 90);
    say("wire in", run);
    const double branch = run.channels.wire_tip_x_mm;
    EXPECT_GT(std::fabs(branch), 10.0);
    run.step(push(40.0, 1.0), 95);
    say("catheter over it", run);
    EXPECT_GT(run.channels.catheter_tip_x_mm * branch, 0.0);
    EXPECT_GT(std::fabs(run.channels.catheter_tip_x_mm), 6.0);
    EXPECT_NEAR(run.channels.wire_insertion_mm, 97.0, 3.0);
    run.step(push(-40.0), 80);
    run.step({}, 20);
    say("wire drawn", run);
    EXPECT_GT(run.channels.catheter_tip_x_mm * branch, 0.0);
    EXPECT_LT(run.channels.wire_insertion_mm, 40.0);
    EXPECT_TRUE(run.finite());
    EXPECT_EQ(run.channels.outside_count, 0.0);
    EXPECT_LT(run.channels.momentum_residual, 1e-9);
}

TEST(CatheterOverWire, RandomFullSpeedOperationOfBothStaysInsideAndFinite) {
    RigRun run("catheter_over_wire");
    double deepest = 0.0, outside = 0.0;
    for (int k = 0; k < 500; ++k) {
        run.step(busy_hands(2 * k));
        ASSERT_TRUE(run.finite()) << k;
        deepest = std::max({deepest, run.channels.wire_penetration_mm, run.channels.catheter_penetration_mm});
        outside = std::max(outside, run.channels.outside_count);
    }
    std::printf("deepest %.2f mm\n", deepest);
    EXPECT_EQ(outside, 0.0);
    EXPECT_LT(deepest, 0.5);
}

TEST(CatheterOverWire, IsTheSameOnAnyNumberOfThreads) {
    std::uint64_t hash[2];
    for (int threads = 1; threads <= 2; ++threads) {
        RigRun run("catheter_over_wire", threads);
        for (int k = 0; k < 60; ++k) run.step(busy_hands(k));
        hash[threads - 1] = run.hash();
    }
    EXPECT_EQ(hash[0], hash[1]);
}

}  // namespace
}  // namespace cathlab
