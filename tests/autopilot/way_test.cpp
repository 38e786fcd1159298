// Where a tip is on its way, and which bends bring a catheter's tip to a place.
#include "autopilot/way.h"

#include <gtest/gtest.h>

#include <cmath>

#include "autopilot/skill.h"
#include "autopilot/steering.h"
#include "core/errors.h"

namespace cathlab {
namespace {

/// A straight vessel of radius 5 mm along z, 100 mm long, with a branch of radius 3 mm along x from its middle.
CentrelineGraph fork() {
    CentrelineGraph graph;
    for (int k = 0; k <= 50; ++k) graph.nodes.push_back({Vec3(0, 0, 2.0 * k), 5.0, 0});
    for (Index k = 0; k < 50; ++k) graph.edges.emplace_back(k, k + 1);
    for (int k = 1; k <= 20; ++k) {
        graph.nodes.push_back({Vec3(2.0 * k, 0, 50), 3.0, 1});
        graph.edges.emplace_back(k == 1 ? 25 : 49 + k, 50 + k);
    }
    return graph;
}

TEST(Way, KnowsHowFarATipHasComeAndHowFarOffItIs) {
    const CentrelineGraph graph = fork();
    const Way way(graph, 0, 50);
    EXPECT_DOUBLE_EQ(way.length_mm(), 100.0);
    const Way::Place place = way.locate(Vec3(0, 3, 40.2));
    EXPECT_EQ(place.arc_mm, 40.0);
    EXPECT_NEAR(place.off_mm, 3.0, 0.01);
    EXPECT_FALSE(place.astray);
    EXPECT_NEAR((way.at(33.0) - Vec3(0, 0, 33)).norm(), 0.0, 1e-12);
    EXPECT_EQ(way.at(1e9), Vec3(0, 0, 100));
}

TEST(Way, ATipInTheBranchIsAstrayAndOneAtTheForkIsNot) {
    const CentrelineGraph graph = fork();
    const Way way(graph, 0, 50);
    EXPECT_TRUE(way.locate(Vec3(25, 0, 50)).astray);
    EXPECT_FALSE(way.locate(Vec3(4, 0, 50)).astray);
    EXPECT_FALSE(Way(graph, 0, 70).locate(Vec3(25, 0, 50)).astray);
}

TEST(Way, WithoutAVesselThereIsASentence) {
    CentrelineGraph graph = fork();
    graph.nodes.push_back({Vec3(500, 0, 0), 5.0, 0});
    EXPECT_THROW(Way(graph, 0, static_cast<Index>(graph.nodes.size()) - 1), UserError);
}

TEST(Steering, FindsTheBendsThatBringTheTipBackToWhereAnotherShapeHadIt) {
    const CentrelineGraph graph = fork();
    const Way way(graph, 0, 50);
    const CatheterSpec spec;
    std::vector<Vec3> nodes;
    for (const CentrelineNode& node : graph.nodes)
        if (node.region == 0) nodes.push_back(node.position);
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
