#include "catheter/give_way.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/units.h"
#include "straight_rail.h"

using namespace cathlab;

namespace {

struct Pushed {
    CatheterSpec spec;
    Rail rail = straight_rail();
    CatheterState state = initial_state(spec, 200.0);
    CatheterShape now;

    CatheterCommand by(const Vec3& force_on_tip, double share = 1.0) {
        now = shape(spec, state, rail);
        const std::vector<WallPush> pushes{{static_cast<Index>(now.points.size() - 1), force_on_tip}};
        return give_way(spec, state, rail, now, pushes, share, h);
    }
    Vec3 tip_after(const CatheterCommand& command) {
        return shape(spec, attempt(spec, state, command, 1.0, h), rail).tip.position;
    }
    static constexpr double h = 0.005;
};

}  // namespace

TEST(GiveWay, APushFromTheSideBendsTheCatheterTheWayThatItIsPushed) {
    for (const double angle : {0.0, 1.0, 2.5, -2.0}) {
        Pushed pushed;
        const Vec3 side(std::cos(angle), std::sin(angle), 0.0);
        const CatheterCommand command = pushed.by(100.0 * side);
        const Vec3 moved = pushed.tip_after(command) - pushed.now.tip.position;
        EXPECT_GT(moved.dot(side), 0.1);
        EXPECT_NEAR(moved.cross(side).z(), 0.0, 1e-3 * moved.norm());
        EXPECT_NEAR(command.advance_mm, 0.0, 1e-6);
    }
}

TEST(GiveWay, APushOnTheEndDrivesItBackAtItsTopSpeed) {
    Pushed pushed;
    const CatheterCommand command = pushed.by(Vec3(0, 0, -500.0));
    EXPECT_NEAR(command.advance_mm, -pushed.spec.max_speed_mm_s * Pushed::h, 1e-3);
    EXPECT_NEAR(pushed.by(Vec3(0, 0, -500.0), 0.25).advance_mm, 0.25 * command.advance_mm, 1e-9);
}

TEST(GiveWay, TheShaftIsNotPulledForward) {
    Pushed pushed;
    EXPECT_EQ(pushed.by(Vec3(0, 0, 500.0)).advance_mm, 0.0);
}

TEST(GiveWay, TheWallsWorkOnTheMotionIsPositive) {
    for (int k = 0; k < 40; ++k) {
        Pushed pushed;
        pushed.state.bend_rad = {0.02 * k, 0.05 * k};
        pushed.state.direction_rad = {0.3 * k, -0.2 * k};
        pushed.state.rotation_rad = 0.1 * k;
        const Vec3 force(std::cos(1.7 * k), std::sin(2.3 * k), std::cos(0.9 * k) - 0.5);
        const CatheterCommand command = pushed.by(200.0 * force);
        EXPECT_GT((pushed.tip_after(command) - pushed.now.tip.position).dot(force), 0.0) << k;
    }
}

TEST(GiveWay, UnloadedItStays) {
    Pushed pushed;
    pushed.state.bend_rad = {0.5, 1.0};
    const CatheterCommand command = pushed.by(Vec3::Zero());
    EXPECT_EQ(command.advance_mm, 0.0);
    EXPECT_EQ(command.rotate_rad, 0.0);
    EXPECT_EQ(command.bend_rad, pushed.state.bend_rad);
    EXPECT_EQ(command.direction_rad, pushed.state.direction_rad);
}
