// Where a tip is on its way, and how often it leaves it.
#include "task/way.h"

#include <gtest/gtest.h>

#include "core/errors.h"
#include "task/detours.h"

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
    const auto some = way.between(39.0, 44.0);
    ASSERT_EQ(some.size(), 3U);
    EXPECT_EQ(some.front().position, Vec3(0, 0, 40));
    EXPECT_EQ(some.back().position, Vec3(0, 0, 44));
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

/// The fork as an anatomy whose goal lies at the far end of the straight vessel.
std::shared_ptr<const AnatomyModel> fork_anatomy() {
    auto anatomy = std::make_shared<AnatomyModel>();
    anatomy->centreline = fork();
    Landmark end;
    end.name = "end";
    end.pose.position = Vec3(0, 0, 100);
    end.node = 50;
    anatomy->landmarks = {end};
    return anatomy;
}

TEST(Detours, CountABranchOnceUntilTheTipHasBeenBackForASecond) {
    Detours detours(fork_anatomy(), "end");
    constexpr double dt = 0.02;
    const auto stay = [&](const Vec3& tip, double seconds) {
        for (double t = 0.0; t < seconds - 1e-9; t += dt) detours.add(tip, dt);
    };
    stay({0, 0, 0}, 0.1);
    EXPECT_DOUBLE_EQ(detours.way_mm(), 100.0);
    stay({30, 0, 50}, 0.5);
    EXPECT_EQ(detours.wrong_branches(), 1);
    stay({0, 0, 48}, 0.5);  // back, but not for long
    stay({30, 0, 50}, 0.5);
    EXPECT_EQ(detours.wrong_branches(), 1);
    stay({0, 0, 48}, 1.5);
    stay({30, 0, 50}, 0.5);
    EXPECT_EQ(detours.wrong_branches(), 2);
}

TEST(Detours, WithoutAWayThereIsNone) {
    Detours detours(fork_anatomy(), "nowhere");
    detours.add({30, 0, 50}, 0.02);
    EXPECT_EQ(detours.way_mm(), 0.0);
    EXPECT_EQ(detours.wrong_branches(), 0);
    Detours none;
    none.add({0, 0, 0}, 0.02);
    EXPECT_EQ(none.way_mm(), 0.0);
}

}  // namespace
}  // namespace cathlab
