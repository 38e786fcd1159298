#include "contrast/along.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/units.h"

using namespace cathlab;

namespace {

constexpr Index root = 0, coronary = 1;

// A root 30 mm wide along z and a coronary 4 mm wide along x, whose line begins on the root's.
CentrelineGraph root_and_coronary() {
    CentrelineGraph graph;
    for (int i = 0; i <= 20; ++i) graph.nodes.push_back({Vec3(0, 0, 2.0 * i), 15.0, root});
    for (int i = 1; i < 21; ++i) graph.edges.emplace_back(i - 1, i);
    for (int i = 1; i <= 30; ++i) {
        graph.nodes.push_back({Vec3(i, 0, 20), i < 12 ? 14.0 - i : 2.0, coronary});  // at first within the root
        graph.edges.emplace_back(i == 1 ? 10 : 19 + i, 20 + i);
    }
    return graph;
}

}  // namespace

TEST(AlongVessels, AWideVesselsWallKeepsItsOwnMediumWhereANarrowOneBegins) {
    const CentrelineGraph graph = root_and_coronary();
    std::vector<double> concentration(graph.nodes.size(), 70.0);
    for (std::size_t i = 21; i < concentration.size(); ++i) concentration[i] = 320.0;
    std::vector<Vec3> points;
    std::vector<Index> region;
    for (int turn = 0; turn < 36; ++turn)
        for (int z = 0; z <= 40; ++z) {
            const double a = turn * 10.0 * units::deg;
            points.emplace_back(15.0 * std::cos(a), 15.0 * std::sin(a), z);
            region.push_back(root);
        }
    const std::size_t wall = points.size();
    for (int x = 16; x <= 30; ++x) {
        points.emplace_back(x, 2.0, 20.0);
        region.push_back(coronary);
    }
    const auto places = along_vessels(graph, points, region, Workers(1));
    for (std::size_t i = 0; i < points.size(); ++i)
        EXPECT_EQ(concentration_at(places[i], concentration), i < wall ? 70.0 : 320.0) << points[i].transpose();
}

TEST(AlongVessels, AFrontLiesStraightAcrossItsVessel) {
    const CentrelineGraph graph = root_and_coronary();
    std::vector<double> concentration(graph.nodes.size(), 0.0);
    for (std::size_t i = 0; i <= 20; ++i) concentration[i] = 10.0 * static_cast<double>(i);  // 5 mg/mL a mm
    std::vector<Vec3> points;
    for (int i = 0; i < 200; ++i)
        points.emplace_back(14.0 * std::cos(0.7 * i), 14.0 * std::sin(0.7 * i), 40.0 * i / 199.0);
    const std::vector<Index> region(points.size(), root);
    const auto places = along_vessels(graph, points, region, Workers(2));
    for (std::size_t i = 0; i < points.size(); ++i)
        EXPECT_NEAR(concentration_at(places[i], concentration), 5.0 * points[i].z(), 1e-9) << points[i].z();
}

TEST(AlongVessels, ARegionWithoutNodesTakesTheNearestOfAll) {
    const CentrelineGraph graph = root_and_coronary();
    const std::vector<Vec3> points{Vec3(25.2, 0.5, 20.0)};
    const std::vector<Index> region{7};
    const AlongVessel place = along_vessels(graph, points, region, Workers(1)).front();
    EXPECT_EQ(std::min(place.from, place.to), 45);
    EXPECT_EQ(std::max(place.from, place.to), 46);
}
