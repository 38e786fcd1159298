// At rest a wire is held by the sheath and the wall alone: their forces sum to nothing.
#include <cstdio>

#include "step/rig.h"

namespace cathlab {
namespace {

TEST(Balance, AtRestTheForcesOfWallAndSheathSumToNothing) {
    struct Case {
        const char* rig;
        double turn_deg_s, speed_mm_s;
    };
    for (const Case& c : {Case{"tube_wire", 0.0, 60.0}, Case{"side_branch", 180.0, 40.0}}) {
        RigRun run(c.rig);
        Input turn;
        turn.rotate = c.turn_deg_s;
        run.step(turn, 25);
        run.step(push(c.speed_mm_s), 100);
        run.step({}, 100);
        const ContactReport report = run.parts.contacts->report(run.parts.wall_state->x);
        ASSERT_FALSE(report.devices.empty());
        const Vec3 wall = report.devices.front().force_mn, sheath = run.parts.wire->sheath_reaction_mn();
        std::printf("%s: wall %.2f mN, with the sheath's %.5f\n", c.rig, wall.norm(), (wall + sheath).norm());
        EXPECT_GT(wall.norm(), 1.0);
        EXPECT_LT((wall + sheath).norm(), 0.001 * wall.norm());
        const Vec3 tip = run.parts.wire->tip();
        run.step({}, 250);
        const Vec3 later = run.parts.contacts->report(run.parts.wall_state->x).devices.front().force_mn;
        std::printf("  5 s later: tip moved %.5f mm, wall %.2f mN\n", (run.parts.wire->tip() - tip).norm(),
                    later.norm());
        EXPECT_LT((run.parts.wire->tip() - tip).norm(), 0.01);
        EXPECT_NEAR(later.norm(), wall.norm(), 0.01 * wall.norm());
    }
}

}  // namespace
}  // namespace cathlab
