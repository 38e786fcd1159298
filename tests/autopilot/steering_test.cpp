// Which bends bring a catheter's tip to a place.
#include "autopilot/steering.h"

#include <gtest/gtest.h>

#include <cmath>

#include "autopilot/attention.h"
#include "autopilot/skill.h"
#include "core/errors.h"
#include "task/way.h"

namespace cathlab {
namespace {

TEST(Steering, FindsTheBendsThatBringTheTipBackToWhereAnotherShapeHadIt) {
    // A straight vessel of radius 5 mm along z, 100 mm long.
    CentrelineGraph graph;
    std::vector<Vec3> nodes;
    for (Index k = 0; k <= 50; ++k) {
        nodes.emplace_back(0.0, 0.0, 2.0 * k);
        graph.nodes.push_back({nodes.back(), 5.0, 0});
        if (k > 0) graph.edges.emplace_back(k - 1, k);
    }
    const Way way(graph, 0, 50);
    const CatheterSpec spec;
    const Rail rail = build_rail(Pose{}, nodes, {});
    CatheterState wanted = initial_state(spec, 90.0);
    wanted.bend_rad = {0.4, 0.9};
    wanted.direction_rad = {0.5, -1.0};
    const Vec3 tip = shape(spec, wanted, rail).tip.position;
    const CatheterState straight = initial_state(spec, 90.0);
    const Bends found = steer(spec, straight, rail, 90.0, way, {tip, 1e6}, bends_of(straight));
    CatheterState reached = straight;
    for (std::size_t k = 0; k < 2; ++k) {
        reached.bend_rad[k] = found.wanted[k].norm();
        reached.direction_rad[k] = std::atan2(found.wanted[k].y(), found.wanted[k].x());
    }
    EXPECT_LT((shape(spec, reached, rail).tip.position - tip).norm(), 1.0);
}

/// A straight vessel of radius 12 mm along z, 100 mm long.
struct WideVessel {
    CentrelineGraph graph;
    std::vector<Vec3> nodes;
    WideVessel() {
        for (Index k = 0; k <= 50; ++k) {
            nodes.emplace_back(0.0, 0.0, 2.0 * k);
            graph.nodes.push_back({nodes.back(), 12.0, 0});
            if (k > 0) graph.edges.emplace_back(k - 1, k);
        }
    }
};

TEST(Steering, KeepsTheRoomThatItIsAskedForWhereTheGoalIsAtTheWall) {
    const WideVessel vessel;
    const Way way(vessel.graph, 0, 50);
    const CatheterSpec spec;
    const Rail rail = build_rail(Pose{}, vessel.nodes, {});
    const CatheterState straight = initial_state(spec, 80.0);
    const auto wall_to_tip = [&](double room_mm) {
        const SteeringGoal goal{Vec3(12.0, 0.0, 78.0), 20.0, room_mm, Vec3::Zero()};
        const Bends found = steer(spec, straight, rail, 80.0, way, goal, bends_of(straight));
        CatheterState reached = straight;
        for (std::size_t k = 0; k < 2; ++k) {
            reached.bend_rad[k] = found.wanted[k].norm();
            reached.direction_rad[k] = std::atan2(found.wanted[k].y(), found.wanted[k].x());
        }
        const Vec3 tip = shape(spec, reached, rail).tip.position;
        return 12.0 - std::sqrt(tip.x() * tip.x() + tip.y() * tip.y()) - spec.radius_mm();
    };
    EXPECT_LT(wall_to_tip(0.0), 2.0);
    EXPECT_GT(wall_to_tip(4.0), 2.0);
}

TEST(Steering, GoesOnWhereTheGoalIsAheadAndBackWhereItIsBehind) {
    const WideVessel vessel;
    const Way way(vessel.graph, 0, 50);
    const CatheterSpec spec;
    const Rail rail = build_rail(Pose{}, vessel.nodes, {});
    const CatheterState now = initial_state(spec, 80.0);
    const auto advance = [&](double z) {
        return approach(spec, now, rail, 3.0, way, {Vec3(0.0, 0.0, z), 20.0, 4.0, Vec3::Zero()}, bends_of(now))
            .advance_mm;
    };
    EXPECT_EQ(advance(90.0), 3.0);
    EXPECT_EQ(advance(80.0), 0.0);
    EXPECT_EQ(advance(70.0), -3.0);
}

TEST(Attention, MovesAndLooksInItsMeansAndGuessesAnewInEachLook) {
    const Skill& novice = find_skill("novice");
    Attention one(novice, 7), again(novice, 7), other(novice, 8);
    constexpr double dt = 0.02;
    constexpr int steps = 100000;
    int looked = 0, guesses = 0, differs = 0;
    double along = 0.0;
    Vec3 last = one.off_mm();
    for (int k = 0; k < steps; ++k) {
        one.step(dt, true);
        again.step(dt, true);
        other.step(dt, true);
        looked += one.looks() ? 1 : 0;
        EXPECT_EQ(one.looks(), again.looks());
        EXPECT_EQ(one.off_mm(), again.off_mm());
        differs += one.off_mm() != other.off_mm() ? 1 : 0;
        if (one.off_mm() == last) continue;
        last = one.off_mm();
        ++guesses;
        along += last.z() * last.z();
    }
    EXPECT_NEAR(static_cast<double>(looked) / steps, novice.looks_s / (novice.looks_s + novice.moves_s), 0.02);
    EXPECT_NEAR(guesses, steps * dt / (novice.looks_s + novice.moves_s), 30);
    EXPECT_NEAR(std::sqrt(along / guesses), novice.depth_mm, 0.6);
    EXPECT_GT(differs, steps / 2);
}

TEST(Attention, AHandThatStandsAtTheGoalDoesNotGuessAnew) {
    Attention still(find_skill("novice"), 3);
    const Vec3 off = still.off_mm();
    for (int k = 0; k < 1000; ++k) still.step(0.02, false);
    EXPECT_EQ(still.off_mm(), off);
    EXPECT_FALSE(still.looks());
    still.guess_again();
    EXPECT_NE(still.off_mm(), off);
}

TEST(Skill, IsFoundByNameOrTheNearestIsNamed) {
    EXPECT_LT(find_skill("expert").reaction_s, find_skill("novice").reaction_s);
    try {
        find_skill("exprt");
        FAIL();
    } catch (const UserError& error) {
        EXPECT_NE(std::string(error.what()).find("'expert'"), std::string::npos);
    }
}

}  // namespace
}  // namespace cathlab
