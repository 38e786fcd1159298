#include <gtest/gtest.h>

#include <cmath>

#include "core/centreline.h"
#include "core/mesh.h"

using namespace cathlab;

namespace {

/// The unit cube, outward.
TriMesh cube() {
    TriMesh m;
    for (int i = 0; i < 8; ++i) m.vertices.emplace_back(i & 1, (i >> 1) & 1, (i >> 2) & 1);
    const int faces[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
    for (const auto& f : faces) {
        m.triangles.emplace_back(f[0], f[1], f[2]);
        m.triangles.emplace_back(f[0], f[2], f[3]);
    }
    return m;
}

}  // namespace

TEST(Mesh, ACubeIsSoundAndHasItsVolumeAndArea) {
    const TriMesh m = cube();
    EXPECT_TRUE(find_faults(m).sound());
    EXPECT_NEAR(signed_volume(m), 1.0, 1e-14);
    EXPECT_NEAR(surface_area(m), 6.0, 1e-14);
}

TEST(Mesh, VolumeDoesNotDependOnThePlaceAndTurnsItsSignInsideOut) {
    TriMesh m = cube();
    for (Vec3& v : m.vertices) v += Vec3(100.0, -30.0, 7.0);
    EXPECT_NEAR(signed_volume(m), 1.0, 1e-9);
    for (Triangle& t : m.triangles) std::swap(t[1], t[2]);
    EXPECT_NEAR(signed_volume(m), -1.0, 1e-9);
    EXPECT_TRUE(find_faults(m).sound());
}

TEST(Mesh, AMissingTriangleLeavesThreeOpenEdges) {
    TriMesh m = cube();
    m.triangles.pop_back();
    const MeshFaults faults = find_faults(m);
    EXPECT_EQ(faults.open_edges, 3U);
    EXPECT_EQ(faults.non_manifold_edges, 0U);
    EXPECT_FALSE(faults.sound());
    EXPECT_NEAR(faults.first_place.x(), 1.0, 1e-12);  // the missing one is of the face x = 1
}

TEST(Mesh, ATurnedTriangleAndADoubledOneAreNonManifold) {
    TriMesh turned = cube();
    std::swap(turned.triangles[0][1], turned.triangles[0][2]);
    EXPECT_EQ(find_faults(turned).non_manifold_edges, 3U);
    TriMesh doubled = cube();
    doubled.triangles.push_back(doubled.triangles[0]);
    EXPECT_EQ(find_faults(doubled).non_manifold_edges, 3U);
}

TEST(Mesh, ATriangleWithTwoEqualCornersIsDegenerate) {
    TriMesh m = cube();
    m.triangles.emplace_back(0, 0, 1);
    EXPECT_EQ(find_faults(m).degenerate_triangles, 1U);
    EXPECT_TRUE(find_faults(TriMesh{}).sound());
}

TEST(Mesh, NormalsOfACubePointOutFromItsMiddle) {
    const TriMesh m = cube();
    const auto normals = vertex_normals(m);
    for (std::size_t i = 0; i < normals.size(); ++i) {
        EXPECT_NEAR(normals[i].norm(), 1.0, 1e-14);
        EXPECT_GT(normals[i].dot(m.vertices[i] - Vec3::Constant(0.5)), 0.5);
    }
    TriMesh lonely = m;
    lonely.vertices.emplace_back(5.0, 5.0, 5.0);
    EXPECT_EQ(vertex_normals(lonely).back(), Vec3::Zero());
}

namespace {

/// A square with a long way round one side: 0 - 1 - 2 - 3 - 0, and 4 apart from all.
CentrelineGraph square() {
    CentrelineGraph g;
    for (const Vec3& p : {Vec3(0, 0, 0), Vec3(2, 0, 0), Vec3(2, 2, 0), Vec3(0, 5, 0), Vec3(9, 9, 9)})
        g.nodes.push_back({p, 1.0, 0});
    g.edges = {{0, 1}, {1, 2}, {2, 3}, {3, 0}};
    return g;
}

}  // namespace

TEST(Centreline, ThePathIsTheShortestByLengthNotByNodes) {
    const CentrelineGraph g = square();
    const auto path = g.path(0, 2);
    EXPECT_EQ(path, (std::vector<Index>{0, 1, 2}));
    EXPECT_NEAR(g.length(path), 4.0, 1e-12);
    EXPECT_NEAR(g.length(g.path(0, 3)), 5.0, 1e-12);
    EXPECT_EQ(g.path(1, 1), (std::vector<Index>{1}));
    EXPECT_TRUE(g.path(0, 4).empty());
    EXPECT_TRUE(g.path(-1, 2).empty());
    EXPECT_EQ(g.length({}), 0.0);
}

TEST(Centreline, APathToANodeThatIsNotThereIsEmpty) {
    EXPECT_TRUE(square().path(0, 99).empty());
    EXPECT_TRUE(square().path(99, 0).empty());
}

TEST(Centreline, NeighboursAreAscendingAndTheNearestIsNearest) {
    const CentrelineGraph g = square();
    EXPECT_EQ(g.adjacency()[0], (std::vector<Index>{1, 3}));
    EXPECT_TRUE(g.adjacency()[4].empty());
    EXPECT_EQ(g.nearest({1.9, 1.8, 0.3}), 2);
    EXPECT_EQ(CentrelineGraph{}.nearest(Vec3::Zero()), -1);
}
