// At rest a wire is held by the sheath and the wall alone: their forces sum to nothing; and what devices press on the
// wall, its supports carry.
#include <cstdio>

#include "step/support_force.h"

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

TEST(Balance, WireAndCatheterOverItAreHeldByTheWallAndTheirSheathsAlone) {
    RigRun run("catheter_over_wire");
    Input turn;
    turn.rotate = 180.0;
    run.step(turn, 25);
    run.step(push(40.0), 90);
    run.step(push(40.0, 1.0), 95);  // into the branch, after the wire
    run.step({}, 150);
    const ContactReport report = run.parts.contacts->report(run.parts.wall_state->x);
    ASSERT_EQ(report.devices.size(), 1U);  // one chain
    const Vec3 wall = report.devices.front().force_mn, sheath = run.parts.wire->sheath_reaction_mn();
    std::printf("wall %.2f mN, with the sheath's %.5f\n", wall.norm(), (wall + sheath).norm());
    EXPECT_GT(run.channels.catheter_force_mn, 1.0);
    EXPECT_LT((wall + sheath).norm(), 0.001 * report.devices.front().normal_mn);
}

TEST(Balance, TheSupportsOfTheWallCarryWhatWireAndSteerableCatheterPressOnIt) {
    SceneSpec spec = rig_spec("fork");
    spec.heart.enabled = false;
    for (SceneEffect& effect : spec.effects) effect.enabled = false;
    RigRun run(spec, "fork");
    run.step(push(60.0), 60);
    Input bent = push(30.0, 1.0);
    bent.proximal_bend = 60.0;
    bent.distal_bend = 40.0;
    run.step(bent, 100);
    bent.advance = 0.0;
    run.step(bent, 400);
    const ContactReport report = run.parts.contacts->report(run.parts.wall_state->x);
    ASSERT_EQ(report.devices.size(), 2U);
    std::vector<Vec3> on_wall(run.parts.wall->size(), Vec3::Zero());
    run.parts.contacts->apply_to_wall(on_wall);
    Vec3 pressed = Vec3::Zero(), on_devices = Vec3::Zero();
    double size = 0.0;
    for (std::size_t i = 0; i < on_wall.size(); ++i)
        if (!run.parts.wall->fixed[i]) pressed += on_wall[i];
    for (const DeviceContact& device : report.devices) {
        on_devices += device.force_mn;
        size += device.total_mn;
        EXPECT_GT(device.normal_mn, 1.0) << device.device;
    }
    const Vec3 carried = force_on_supports(run);
    std::printf("contacts %.2f mN in all, %.2f as a sum; supports carry %.2f, %.5f are missing\n", size, pressed.norm(),
                carried.norm(), (carried - pressed).norm());
    EXPECT_GT(pressed.norm(), 1.0);
    EXPECT_LT((carried - pressed).norm(), 0.001 * size);
}

}  // namespace
}  // namespace cathlab
