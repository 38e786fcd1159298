#include "contact/closest_point.h"

#include <gtest/gtest.h>

#include <limits>

#include "contact/triangle_point.h"
#include "shapes.h"

namespace cathlab {
namespace {

using test::Surface;
constexpr double far = std::numeric_limits<double>::infinity();

TriMesh curved_tube(double radius, int round = 12) {
    TriMesh mesh;
    test::add_tube(
        mesh, [](double s) { return Vec3(25.0 * std::cos(3.0 * s), 0.0, 25.0 * std::sin(3.0 * s)); }, radius, 40,
        round);
    return mesh;
}

/// Random points near the surface and anywhere around it.
void agrees_with_brute_force(const Surface& s, int points, std::uint64_t stream) {
    for (int i = 0; i < points; ++i) {
        const auto n = static_cast<std::uint64_t>(i);
        const auto v = static_cast<std::size_t>(
            test::uniform(stream, 7 * n, 0.0, static_cast<double>(s.state.vertices.size()) - 0.5));
        const Vec3 p = s.state.vertices[v] + test::uniform_vector(stream + 1, n, i % 3 == 0 ? 0.3 : 4.0);
        const SurfacePoint found = closest(s.model, s.state, p, far);
        const double expected = test::slow_signed_distance(s, p);
        ASSERT_NEAR(found.signed_distance, expected, 1e-9) << "point " << i << " at " << p.transpose();
        ASSERT_NEAR((p - found.point).norm(), std::fabs(expected), 1e-9);
        ASSERT_NEAR(found.barycentric.sum(), 1.0, 1e-12);
        ASSERT_GE(found.barycentric.minCoeff(), 0.0);
        ASSERT_NEAR((p - found.point).dot(found.inward_normal), expected, 1e-9);
    }
}

TEST(ClosestPoint, AgreesWithBruteForceAndWindingNumberOnACurvedThinTube) {
    agrees_with_brute_force(Surface(curved_tube(1.5)), 600, 100);
}

TEST(ClosestPoint, AgreesWithBruteForceOnDeformedTubes) {
    for (std::uint64_t k = 0; k < 3; ++k) {
        const TriMesh mesh = curved_tube(2.0 + 2.0 * static_cast<double>(k));
        Surface s(mesh);
        s.move_to(test::deformed(mesh.vertices, 1.0 + static_cast<double>(k)));
        agrees_with_brute_force(s, 300, 200 + 10 * k);
    }
}

TEST(ClosestPoint, AgreesWithBruteForceOnATorus) {
    agrees_with_brute_force(Surface(test::torus(12.0, 3.0, 40, 14)), 600, 300);
}

TEST(ClosestPoint, AgreesWithBruteForceOnTwoNeighbouringTubes) {
    TriMesh mesh = test::straight_tube(2.0, 20.0, 20, 12);
    test::add_tube(
        mesh, [](double s) { return Vec3(4.4, 0.0, 20.0 * s); }, 2.0, 20, 12);
    agrees_with_brute_force(Surface(mesh), 600, 400);
}

TEST(ClosestPoint, ARefittedTreeAnswersAsARebuiltOne) {
    const TriMesh mesh = curved_tube(3.0);
    Surface moved(mesh);
    TriMesh bent = mesh;
    bent.vertices = test::deformed(mesh.vertices, 3.0);
    moved.move_to(bent.vertices);
    const Surface rebuilt(bent);
    for (std::uint64_t i = 0; i < 2000; ++i) {
        const Vec3 p = test::uniform_vector(500, i, 30.0);
        const SurfacePoint a = closest(moved.model, moved.state, p, far);
        const SurfacePoint b = closest(rebuilt.model, rebuilt.state, p, far);
        ASSERT_EQ(a.triangle, b.triangle);
        ASSERT_EQ(a.signed_distance, b.signed_distance);
    }
}

TEST(ClosestPoint, AHintDoesNotChangeTheAnswerInOneVessel) {
    const Surface s(curved_tube(3.0));
    for (std::uint64_t i = 0; i < 3000; ++i) {
        const Vec3 p = s.state.vertices[i % 480] + test::uniform_vector(600, i, 2.5);
        const SurfacePoint plain = closest(s.model, s.state, p, far);
        const Vec3 earlier = p + test::uniform_vector(601, i, 0.4);
        const SurfacePoint hinted = closest(s.model, s.state, p, far, closest(s.model, s.state, earlier, far).triangle);
        ASSERT_EQ(plain.triangle, hinted.triangle);
        ASSERT_EQ(plain.signed_distance, hinted.signed_distance);
    }
}

TEST(ClosestPoint, NothingIsFoundBeyondTheReach) {
    const Surface s(test::straight_tube(5.0, 40.0, 40, 24));
    EXPECT_FALSE(closest(s.model, s.state, Vec3(0, 0, 20), 3.0).found());
    EXPECT_TRUE(closest(s.model, s.state, Vec3(0, 0, 20), 5.1).found());
}

TEST(ClosestPoint, APointThatSlippedOutStaysWithItsVesselThoughTheNeighbourIsNearer) {
    TriMesh mesh = test::straight_tube(2.0, 30.0, 40, 24);
    test::add_tube(
        mesh, [](double s) { return Vec3(4.3, 0.0, 30.0 * s); }, 2.0, 40, 24);  // a gap of 0.3 mm
    const Surface s(mesh);
    Index hint = closest(s.model, s.state, Vec3(1.6, 0, 15), far).triangle;
    const Index first = hint;
    for (double x = 1.6; x < 4.0; x += 0.2) {  // through both walls into the middle of the neighbour
        const SurfacePoint found = closest(s.model, s.state, Vec3(x, 0.05, 15.1), far, hint);
        EXPECT_LT(found.point.x(), 2.01) << x;
        EXPECT_NEAR(found.signed_distance, 2.0 - x, 0.05) << x;
        EXPECT_LT(found.inward_normal.x(), -0.95);
        hint = found.triangle;
    }
    // In one leap of 1.6 mm from the axis as well.
    EXPECT_LT(closest(s.model, s.state, Vec3(2.25, 0, 15), far, first).signed_distance, 0.0);
    // Without memory the nearest wall wins, which is why samples carry hints.
    EXPECT_GT(closest(s.model, s.state, Vec3(2.6, 0, 15.1), far).signed_distance, 0.0);
}

TEST(ClosestPoint, ASheetThatASphereNeverWentThroughIsNotItsWall) {
    TriMesh mesh = test::straight_tube(5.0, 30.0, 40, 48);
    test::add_tube(
        mesh, [](double s) { return Vec3(1.0, 0.0, 30.0 * s); }, 2.0, 40,
        24);  // as a fold: inside, and seen from behind
    const Surface s(mesh);
    const Vec3 p(4.5, 0.05, 15.1);
    const Index fold = closest(s.model, s.state, Vec3(2.8, 0, 15), far).triangle;
    constexpr double radius = 1.0;
    EXPECT_NEAR(closest(s.model, s.state, p, far, fold).signed_distance, -1.5, 0.05);
    const auto seen = [&](const Vec3& at, Index hint, double depth_mm, const Vec3& pressed_by = Vec3::Zero()) {
        return closest_credible(s.model, s.state, at, far, hint, radius, {depth_mm, pressed_by});
    };
    ASSERT_TRUE(seen(p, fold, 0.0).found());
    EXPECT_NEAR(seen(p, fold, 0.0).signed_distance, 0.5, 0.05);
    // One that was as deep before may have gone through it, and so may one that was pressed from there.
    EXPECT_NEAR(seen(p, fold, 1.6).signed_distance, -1.5, 0.05);
    EXPECT_NEAR(seen(p, fold, 0.0, -Vec3::UnitX()).signed_distance, -1.5, 0.05);
    EXPECT_NEAR(seen(p, fold, 0.0, Vec3::UnitX()).signed_distance, 0.5, 0.05);
    // Where all there is lies too deep, there is no wall.
    const Vec3 beyond(6.0, 0.05, 15.1);
    EXPECT_FALSE(seen(beyond, -1, 0.0).found());
    EXPECT_TRUE(seen(beyond, -1, 1.2).found());
}

TEST(ClosestPoint, APointThatCrossesTheLumenChangesWalls) {
    const Surface s(test::straight_tube(4.0, 40.0, 40, 24));
    Index hint = closest(s.model, s.state, Vec3(-3.5, 0, 20), far).triangle;
    for (double x = -3.5; x <= 3.5; x += 0.5) {
        const SurfacePoint found = closest(s.model, s.state, Vec3(x, 0.1, 20.1), far, hint);
        EXPECT_EQ(found.triangle, closest(s.model, s.state, Vec3(x, 0.1, 20.1), far).triangle);
        hint = found.triangle;
    }
}

TEST(ClosestPoint, OnTheSurfaceTheNormalIsThePseudoNormal) {
    const Surface s(test::straight_tube(4.0, 40.0, 41, 24));
    const Vec3 corner = s.state.vertices[24 * 20 + 3];
    const SurfacePoint found = closest(s.model, s.state, corner, 1.0);
    EXPECT_NEAR(found.inward_normal.norm(), 1.0, 1e-12);
    EXPECT_LT(found.inward_normal.dot(Vec3(corner.x(), corner.y(), 0).normalized()), -0.999);
}

TEST(ClosestPoint, APathOutOfTheLumenIsCutAtTheWall) {
    const Surface s(test::straight_tube(2.0, 40.0, 60, 48));
    for (std::uint64_t i = 0; i < 500; ++i) {
        const double phi = test::uniform(700, i, 0.0, 6.28);
        const Vec3 a(0, 0, test::uniform(701, i, 5.0, 35.0));
        const Vec3 b = a + test::uniform(702, i, 3.0, 9.0) * Vec3(std::cos(phi), std::sin(phi), 0.2);
        const auto exit = first_exit(s.model, s.state, a, b);
        ASSERT_TRUE(exit.has_value());
        const double radial = std::hypot(exit->point.x(), exit->point.y());
        EXPECT_GT(radial, 2.0 * std::cos(std::numbers::pi / 48) - 1e-9);
        EXPECT_LT(radial, 2.0 + 1e-9);
        const Triangle& t = s.model.triangles[static_cast<std::size_t>(exit->triangle)];
        Vec3 again = Vec3::Zero();
        for (int k = 0; k < 3; ++k) again += exit->barycentric[k] * s.state.vertices[static_cast<std::size_t>(t[k])];
        EXPECT_NEAR((again - exit->point).norm(), 0.0, 1e-9);
        EXPECT_FALSE(first_exit(s.model, s.state, b, a).has_value() && s.model.triangles.empty());
        EXPECT_FALSE(first_exit(s.model, s.state, b, 0.5 * (exit->point + b)).has_value());  // outside all along
    }
    EXPECT_FALSE(first_exit(s.model, s.state, Vec3(0, 0, 10), Vec3(0.5, 0.5, 12)).has_value());
    EXPECT_FALSE(first_exit(s.model, s.state, Vec3(1, 0, 10), Vec3(1, 0, 10)).has_value());
}

std::vector<SurfacePoint> others(const Surface& s, const Vec3& p, double reach, int at_most) {
    const SurfacePoint nearest = closest(s.model, s.state, p, reach);
    return further_walls(s.model, s.state, p, reach, nearest,
                         inward_smooth_normal(s.model, s.state, nearest.triangle, nearest.barycentric), at_most);
}

TEST(ClosestPoint, AFlatWallHasOneContactAndANarrowTubeManyAround) {
    const Surface wide(test::straight_tube(12.0, 60.0, 80, 64));
    EXPECT_TRUE(others(wide, Vec3(11.6, 0, 30.2), 2.0, 4).empty());

    const Surface narrow(test::straight_tube(1.0, 20.0, 40, 16));
    const Vec3 centre(0.1, 0.03, 10.1);
    const SurfacePoint nearest = closest(narrow.model, narrow.state, centre, 2.0);
    const auto more = others(narrow, centre, 2.0, 4);
    ASSERT_EQ(more.size(), 4u);
    for (const SurfacePoint& w : more) {
        EXPECT_LT(w.inward_normal.dot(nearest.inward_normal), 0.91);
        EXPECT_LT(std::fabs(w.inward_normal.z()), 0.1);
        EXPECT_GT(w.signed_distance, 0.8);  // the planes of the far side are as far as the wall
        EXPECT_LT(w.signed_distance, 1.1);
    }
}

TEST(ClosestPoint, ACornerOfTwoWallsGivesBoth) {
    const Surface s(test::straight_tube(6.0, 30.0, 40, 40));
    const auto more = others(s, Vec3(5.4, 0.1, 0.5), 2.0, 4);  // beside the flat end
    ASSERT_GE(more.size(), 1u);
    double most = 0.0;  // one of the two, or the bevel that stands for their edge, faces along the tube
    for (const SurfacePoint& w : more) most = std::max(most, w.inward_normal.z());
    EXPECT_GT(most, 0.5);
}

TEST(ClosestPoint, ARidgeHasNoWallBehindIt) {
    // Outside a torus' hole the wall bulges towards a point inside the tube from neither side: but turned inside out,
    // the tube is a ridge for points around it.
    TriMesh mesh = test::torus(8.0, 2.0, 60, 24);
    for (Triangle& t : mesh.triangles) std::swap(t[1], t[2]);
    const Surface s(mesh);
    EXPECT_TRUE(others(s, Vec3(10.3, 0.2, 0.1), 2.0, 4).empty());
}

TEST(ClosestPoint, DegenerateTrianglesAreHarmless) {
    const Vec3 a(0, 0, 0), b(1, 0, 0);
    for (const Vec3& c : {Vec3(0.5, 0, 0), Vec3(0, 0, 0), Vec3(3, 0, 0), Vec3(0.5, 1e-14, 0)}) {
        const TrianglePoint t = closest_on_triangle(Vec3(0.4, 2, 0), a, b, c);
        EXPECT_NEAR(t.squared_distance, 4.0, 1e-9);
        EXPECT_NEAR(t.barycentric.sum(), 1.0, 1e-12);
    }
    EXPECT_NEAR(closest_on_triangle(Vec3(0, 2, 0), a, a, a).squared_distance, 4.0, 1e-15);

    TriMesh mesh = test::straight_tube(3.0, 20.0, 20, 12);
    Surface s(mesh);
    std::vector<Vec3> crushed = mesh.vertices;
    for (std::size_t v = 12 * 9; v < 12 * 11; ++v) crushed[v] = crushed[12 * 9];  // two rings fall into one point
    s.move_to(crushed);
    for (std::uint64_t i = 0; i < 500; ++i) {
        const Vec3 p = crushed[12 * 9] + (i == 0 ? Vec3(Vec3::Zero()) : test::uniform_vector(800, i, 1.0));
        const SurfacePoint found = closest(s.model, s.state, p, far);
        ASSERT_TRUE(found.point.allFinite() && found.inward_normal.allFinite() && std::isfinite(found.signed_distance));
    }
}

TEST(ClosestPoint, APointThatIsNotFiniteIsADevelopersMistake) {
    const Surface s(test::straight_tube(3.0, 20.0, 20, 12));
    EXPECT_THROW(closest(s.model, s.state, Vec3(0, std::nan(""), 0), 1.0), std::logic_error);
    EXPECT_THROW(first_exit(s.model, s.state, Vec3::Zero(), Vec3(0, 0, INFINITY)), std::logic_error);
    EXPECT_THROW(closest(s.model, s.state, Vec3::Zero(), 1.0, 1 << 20), std::logic_error);
}

TEST(LumenSurface, TheUpdateDoesNotDependOnTheNumberOfThreads) {
    const TriMesh mesh = test::straight_tube(10.0, 200.0, 250, 40);
    const Surface one(mesh, 1);
    const Surface three(mesh, 3);
    for (std::size_t n = 0; n < one.state.boxes.node.size(); ++n) {
        ASSERT_EQ(one.state.boxes.node[n].low, three.state.boxes.node[n].low);
        ASSERT_EQ(one.state.boxes.node[n].high, three.state.boxes.node[n].high);
    }
}

TEST(LumenSurface, ABindingOfTheWrongSizeIsRefused) {
    const TriMesh mesh = test::straight_tube(3.0, 20.0, 20, 12);
    EXPECT_THROW(build_lumen_surface(mesh, {}, {}, test::one_to_one(5)), std::logic_error);
    EXPECT_THROW(build_lumen_surface(mesh, std::vector<Index>(3, 0), {}, test::one_to_one(mesh.vertices.size())),
                 std::logic_error);
}

}  // namespace
}  // namespace cathlab
