// Whose friction it is that a device meets at the wall.
#include <cstdio>

#include "step/rig.h"

namespace cathlab {
namespace {

const std::string devices = std::string(CATHLAB_SOURCE_DIR) + "/assets/devices/";

TEST(DeviceFriction, IsTheDevicesOwnUnlessTheSceneSaysSoForAll) {
    SceneSpec spec = rig_spec("fork");
    spec.wire.device = devices + "hydrophilic-035-angled.toml";
    const RigRun own(spec, "fork");
    EXPECT_EQ(own.parts.wire->spec().friction, 0.033);
    EXPECT_EQ(own.parts.catheter->friction, 0.1);
    spec.wall.friction = 0.25;
    const RigRun all(spec, "fork");
    EXPECT_EQ(all.parts.wire->spec().friction, 0.25);
    EXPECT_EQ(all.parts.catheter->friction, 0.25);
}

TEST(DeviceFriction, APassiveCatheterRubsWithItsOwnAndTheWireAheadOfItWithTheWires) {
    SceneSpec spec = rig_spec("side_branch");
    spec.wire.device = devices + "hydrophilic-035-angled.toml";
    spec.catheter.enabled = true;
    spec.catheter.device = devices + "polymer-5f.toml";
    spec.catheter.entry = spec.wire.entry;
    spec.catheter.insertion_mm = 10.0;
    RigRun run(spec, "side_branch");
    Input turn;
    turn.rotate = 180.0;
    run.step(turn, 25);
    int wire = 0, tube = 0;
    for (int k = 0; k < 185; ++k) {
        run.step(push(40.0, k < 90 ? 0.0 : 1.0));
        const double front = run.parts.wire->insertion_mm() - run.parts.wire->sleeve_insertion_mm();
        for (std::size_t i = 0; i < run.parts.contacts->rows().size(); ++i) {
            const double behind = run.parts.contacts->wall_rows()[i].arc_mm - front;
            if (std::fabs(behind) < 0.5) continue;
            EXPECT_EQ(run.parts.contacts->rows()[i].friction, behind < 0.0 ? 0.033 : 0.1);
            (behind < 0.0 ? wire : tube) += 1;
        }
    }
    EXPECT_GT(wire, 0);
    EXPECT_GT(tube, 0);
}

TEST(DeviceFriction, ACoatedWireIsPushedRoundABendWithLessForce) {
    double force[2] = {0.0, 0.0};
    for (int bare = 0; bare < 2; ++bare) {
        SceneSpec spec = rig_spec("side_branch");
        spec.wire.device = devices + "hydrophilic-035-angled.toml";
        if (bare) spec.wall.friction = 0.2;  // six times the coat's [schroeder1993]
        RigRun run(spec, "side_branch");
        Input turn;
        turn.rotate = 180.0;
        run.step(turn, 25);
        for (int k = 0; k < 125; ++k) {
            run.step(push(40.0));
            force[bare] += run.channels.wire_sheath_force_mn / 125.0;
        }
    }
    std::printf("mean push %.1f mN coated, %.1f mN bare\n", force[0], force[1]);
    EXPECT_GT(force[0], 0.0);
    EXPECT_GT(force[1], 1.2 * force[0]);
}

}  // namespace
}  // namespace cathlab
