#include "scene/vessel_direction.h"

#include <gtest/gtest.h>

namespace cathlab {
namespace {

TEST(VesselDirection, AWideVesselKeepsItsOwnWayWhereAThinBranchLeavesIt) {
    CentrelineGraph graph;
    for (int k = 0; k <= 10; ++k) graph.nodes.push_back({Vec3(0, 0, 4.0 * k), 12.0, 0});
    for (int k = 0; k < 10; ++k) graph.edges.emplace_back(k, k + 1);
    for (int k = 1; k <= 10; ++k) {  // a branch along x from the middle
        graph.nodes.push_back({Vec3(3.0 * k, 0, 20.0), 2.0, 1});
        graph.edges.emplace_back(k == 1 ? 5 : 9 + k, 10 + k);
    }
    const std::vector<Vec3> places{{12, 0, 8}, {0, 12, 20}, {-12, 0, 20}, {25, 2, 20}};
    const std::vector<Vec3> found = vessel_directions(graph, places);
    for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(std::fabs(found[i].z()), 1.0, 1e-12) << i;
    EXPECT_NEAR(std::fabs(found[3].x()), 1.0, 1e-12);
}

TEST(VesselDirection, AGraphWithoutEdgesHasNone) {
    CentrelineGraph graph;
    graph.nodes.push_back({Vec3::Zero(), 5.0, 0});
    const std::vector<Vec3> places{{5, 0, 0}};
    EXPECT_EQ(vessel_directions(graph, places).front(), Vec3(Vec3::Zero()));
}

}  // namespace
}  // namespace cathlab
