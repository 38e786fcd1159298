// Which bends bring a catheter's tip to a place.
#include "autopilot/steering.h"

#include <gtest/gtest.h>

#include <cmath>

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
