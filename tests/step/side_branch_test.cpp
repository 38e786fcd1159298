// A preshaped tip that is turned at the sheath finds the branch that it is turned to.
#include <cstdio>

#include "core/units.h"
#include "step/rig.h"

namespace cathlab {
namespace {

/// Where the tip ends (world x: + is the left branch) after a turn at the sheath in the trunk and an advance of 80 mm.
double branch_after_turn(double turn_deg) {
    RigRun run("side_branch");
    Input turn;
    turn.rotate = turn_deg / 0.5;
    run.step(turn, 25);
    run.step({}, 10);
    run.step(push(50.0), 80);
    EXPECT_TRUE(run.finite());
    EXPECT_EQ(run.channels.outside_count, 0.0);
    std::printf("turned by %4.0f deg: tip at (%.1f, %.1f, %.1f), refused %.1f mm\n", turn_deg,
                run.channels.wire_tip_x_mm, run.channels.wire_tip_y_mm, run.channels.wire_tip_z_mm,
                run.channels.wire_refused_mm);
    EXPECT_LT(run.channels.wire_tip_z_mm, -75.0);
    return run.channels.wire_tip_x_mm;
}

TEST(SideBranch, AnAngledTipTurnedAtTheSheathTakesTheBranchThatItPointsTo) {
    const double first = branch_after_turn(-90.0), second = branch_after_turn(90.0);
    EXPECT_GT(std::fabs(first), 8.0);
    EXPECT_GT(std::fabs(second), 8.0);
    EXPECT_LT(first * second, 0.0);
}

}  // namespace
}  // namespace cathlab
