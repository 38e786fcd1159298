#include "catheter/wall_limit.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/units.h"
#include "straight_rail.h"

using namespace cathlab;

namespace {

WallLimit wall_at(std::size_t point, const Vec3& normal, double gap, double force = 0.0) {
    WallLimit limit;
    limit.point = static_cast<Index>(point);
    limit.normal = normal;
    limit.gap = gap;
    limit.force = force;
    return limit;
}

}  // namespace

TEST(WallLimit, TheFractionIsTheRoomOverTheMotion) {
    const std::vector<Vec3> from = {Vec3::Zero()}, to = {Vec3(2.0, 0.0, 0.0)};
    const Vec3 inward = -Vec3::UnitX();
    EXPECT_DOUBLE_EQ(allowed_fraction(from, to, std::vector{wall_at(0, inward, 5.0)}), 1.0);
    EXPECT_DOUBLE_EQ(allowed_fraction(from, to, std::vector{wall_at(0, inward, 0.5)}),
                     0.5);  // 0.5 free + 0.5 allowed of 2
    EXPECT_DOUBLE_EQ(allowed_fraction(from, to, std::vector{wall_at(0, inward, -0.5)}), 0.0);
    EXPECT_DOUBLE_EQ(allowed_fraction(from, to, std::vector{wall_at(0, inward, -2.0)}), 0.0);
    EXPECT_DOUBLE_EQ(allowed_fraction(from, to, std::vector{wall_at(0, Vec3::UnitX(), -2.0)}), 1.0);  // moving away
}

TEST(WallLimit, ASampleAtItsForceLimitMovesNoFurtherIn) {
    const std::vector<Vec3> from = {Vec3::Zero()}, in = {Vec3(0.01, 0.0, 0.0)}, out = {Vec3(-0.01, 0.0, 0.0)};
    const std::vector limits{wall_at(0, -Vec3::UnitX(), 0.1, 3000.0)};
    EXPECT_EQ(allowed_fraction(from, in, limits), 0.0);
    EXPECT_EQ(allowed_fraction(from, out, limits), 1.0);
    EXPECT_EQ(allowed_fraction(from, in, std::vector{wall_at(0, -Vec3::UnitX(), 0.1, 2999.0)}), 1.0);
}

TEST(WallLimit, PointsAreMatchedFromTheTip) {
    const std::vector<Vec3> from = {Vec3(0, 0, 0), Vec3(0, 0, 1)};
    const std::vector<Vec3> to = {Vec3(0, 0, 0), Vec3(0, 0, 1), Vec3(0, 0, 2)};
    EXPECT_DOUBLE_EQ(allowed_fraction(from, to, std::vector{wall_at(1, -Vec3::UnitZ(), 0.0)}), 0.5);
}

TEST(WallLimit, TheTakenPartKeepsThePredictedPenetrationUnderItsLimit) {
    const CatheterSpec spec;
    const Rail rail = straight_rail();
    CatheterState state = initial_state(spec, 120.0);
    const CatheterShape start = shape(spec, state, rail);
    const std::vector limits{wall_at(start.points.size() - 1, -Vec3::UnitZ(), -0.4)};
    CatheterCommand command;
    command.advance_mm = 0.4;
    const CatheterTaken taken = take(spec, state, command, rail, limits, 0.004);
    const double room = predicted_share * 0.5 - 0.4;
    EXPECT_NEAR(taken.state.insertion_mm, 120.0 + room, 1e-9);
    EXPECT_NEAR(taken.refused, 1.0 - room / 0.4, 1e-9);
    EXPECT_NEAR(taken.refused_advance_mm, 0.4 - room, 1e-9);
    EXPECT_NEAR(taken.shape.tip.position.z(), 120.0 + room, 1e-9);
}

TEST(WallLimit, ABlockedAdvanceDoesNotBlockStraightening) {
    const CatheterSpec spec;
    const Rail rail = straight_rail();
    CatheterState state = initial_state(spec, 120.0);
    state.bend_rad = {0.0, 90.0 * units::deg};  // tip points to +x
    const CatheterShape start = shape(spec, state, rail);
    // The wall lies ahead of the elbow in the middle of the shaft: nothing may go on in z there.
    const std::size_t base = 30;
    const std::vector limits{wall_at(base, -Vec3::UnitZ(), -0.5)};
    CatheterCommand command;
    command.advance_mm = 0.4;
    command.bend_rad = {0.0, 0.0};
    command.direction_rad = {0.0, 0.0};
    const CatheterTaken taken = take(spec, state, command, rail, limits, 0.004);
    EXPECT_NEAR(taken.state.insertion_mm, 120.0, 1e-9);
    EXPECT_NEAR(taken.state.bend_rad[1], 90.0 * units::deg - 140.0 * units::deg * 0.004, 1e-9);
    EXPECT_EQ(taken.fraction.bend[1], 1.0);
    EXPECT_NEAR(taken.refused, 1.0, 1e-12);
}

TEST(WallLimit, WithoutAWallAllIsTaken) {
    const CatheterSpec spec;
    const Rail rail = straight_rail();
    CatheterCommand command;
    command.advance_mm = 0.2;
    const CatheterTaken taken = take(spec, initial_state(spec, 50.0), command, rail, {}, 0.004);
    EXPECT_EQ(taken.refused, 0.0);
    EXPECT_DOUBLE_EQ(taken.state.insertion_mm, 50.2);
}

TEST(WallLimit, DrivenAgainstAWallForLongItStaysWithinTheLimit) {
    // A rigid plane at x = 9: the true gap of every sample is known, so the linear prediction can be checked against
    // it.
    const CatheterSpec spec;
    const Rail rail = straight_rail();
    CatheterState state = initial_state(spec, 150.0);
    CatheterCommand command;
    command.bend_rad = {60.0 * units::deg, 140.0 * units::deg};
    command.direction_rad = {0.3, 0.0};
    command.rotate_rad = 0.01;
    command.advance_mm = 0.2;
    double deepest = 0.0;
    for (int step = 0; step < 1000; ++step) {
        const CatheterShape now = shape(spec, state, rail);
        std::vector<WallLimit> limits;
        for (std::size_t i = 0; i < now.points.size(); ++i) {
            const double gap = 9.0 - now.points[i].x() - spec.radius_mm();
            deepest = std::max(deepest, -gap);
            if (gap < 3.0) limits.push_back(wall_at(i, -Vec3::UnitX(), gap));
        }
        state = take(spec, state, command, rail, limits, 0.004).state;
    }
    EXPECT_GT(deepest, 0.3);
    EXPECT_LT(deepest, 0.5);
}
