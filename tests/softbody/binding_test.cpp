#include "softbody/binding.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/errors.h"
#include "rig.h"

namespace cathlab {
namespace {

/// A lumen surface coarser than the wall: vertices beside the particles, with their normals.
struct Surface {
    TriMesh mesh;
    std::vector<Vec3> normals;
};

Surface surface(double radius, double length) {
    TubeShape tube = rig::shape(radius, length);
    tube.edge_mm = radius / 2.0;
    Surface s{tube_mesh(tube), {}};
    s.normals = vertex_normals(s.mesh);
    return s;
}

class Bound : public ::testing::Test {
protected:
    SoftBodyModel model = rig::free_tube();
    Surface lumen = surface(12.0, 60.0);
    PointBinding binding = bind_points(model, lumen.mesh.vertices, 10, true, lumen.normals);
};

TEST_F(Bound, EveryPointIsReproducedAtRestWithModestWeights) {
    for (std::size_t i = 0; i < binding.size(); ++i) {
        ASSERT_NEAR((evaluate(binding, i, model.rest) - lumen.mesh.vertices[i]).norm(), 0.0, 1e-9);
        double sum = 0.0;
        for (Index k = binding.start[i]; k < binding.start[i + 1]; ++k)
            sum += binding.weight[static_cast<std::size_t>(k)];
        ASSERT_NEAR(sum, 1.0, 1e-12);
    }
    EXPECT_LT(binding.largest_weight(), 1.0);
    RecordProperty("largest_weight_percent", static_cast<int>(100 * binding.largest_weight()));
    std::printf("largest weight %.3f, %.1f particles a point\n", binding.largest_weight(),
                static_cast<double>(binding.particle.size()) / static_cast<double>(binding.size()));
}

TEST_F(Bound, AnAffineMotionCarriesTheSurfaceAlongExactly) {
    Mat3 stretch;
    stretch << 1.2, 0.1, -0.3, 0.05, 0.8, 0.2, 0.0, -0.1, 1.4;
    const Vec3 shift(3, -20, 7);
    std::vector<Vec3> x;
    for (const Vec3& p : model.rest) x.push_back(stretch * p + shift);
    std::vector<Vec3> moved(binding.size());
    evaluate_all(binding, x, moved, Workers(2));
    for (std::size_t i = 0; i < binding.size(); ++i)
        ASSERT_NEAR((moved[i] - (stretch * lumen.mesh.vertices[i] + shift)).norm(), 0.0, 1e-9);
}

TEST_F(Bound, ARigidlyMovedBodyHasTheRigidlyMovedSurface) {
    const Mat3 turn = det::rotation_from_vector(Vec3(0.7, -1.1, 2.0)).toRotationMatrix();
    std::vector<Vec3> x;
    for (const Vec3& p : model.rest) x.push_back(turn * p + Vec3(100, 50, -20));
    for (std::size_t i = 0; i < binding.size(); ++i)
        ASSERT_NEAR((evaluate(binding, i, x) - (turn * lumen.mesh.vertices[i] + Vec3(100, 50, -20))).norm(), 0.0, 1e-9);
}

TEST_F(Bound, AForceReturnsWithItsSumAndItsTorque) {
    std::vector<Vec3> x;
    for (std::size_t i = 0; i < model.size(); ++i) x.push_back(model.rest[i] + rig::random_vector(i, 1.0));
    for (std::size_t i = 0; i < binding.size(); i += 7) {
        std::vector<Vec3> force(model.size(), Vec3::Zero());
        const Vec3 f = rig::random_vector(i + 1000, 800.0);
        add_force(binding, i, f, force);
        Vec3 sum = Vec3::Zero(), torque = Vec3::Zero();
        for (std::size_t j = 0; j < model.size(); ++j) {
            sum += force[j];
            torque += x[j].cross(force[j]);
        }
        ASSERT_NEAR((sum - f).norm(), 0.0, 1e-9);
        ASSERT_NEAR((torque - evaluate(binding, i, x).cross(f)).norm(), 0.0, 1e-7);
    }
}

TEST_F(Bound, TheSurfaceHasNoStepsWhereParticlesChangeHands) {
    // A smooth bulge of the wall, sampled along a line of close points: the surface follows it, and its slope does not
    // jump.
    std::vector<Vec3> line, normals;
    for (int k = 0; k <= 400; ++k) {
        line.emplace_back(12.0, 0.0, 20.0 + 0.05 * k);
        normals.emplace_back(1, 0, 0);
    }
    const PointBinding close = bind_points(model, line, 10, true, normals);
    const auto bulge = [](double z) { return 3.0 * std::exp(-(z - 30.0) * (z - 30.0) / 50.0); };
    std::vector<Vec3> x;
    for (const Vec3& p : model.rest) x.push_back(p + Vec3(bulge(p.z()), 0, 0));
    double worst = 0.0, step = 0.0, last = 0.0;
    for (std::size_t i = 0; i < line.size(); ++i) {
        const double error = evaluate(close, i, x).x() - 12.0 - bulge(line[i].z());
        worst = std::max(worst, std::fabs(error));
        if (i > 0) step = std::max(step, std::fabs(error - last));
        last = error;
    }
    EXPECT_LT(worst, 0.2);
    EXPECT_LT(step, 0.02);
    std::printf("bulge of 3 mm: error %.3f mm, largest step over 0.05 mm: %.4f mm\n", worst, step);
}

TEST_F(Bound, ACentreLineNodeRidesOnTheWallAroundIt) {
    std::vector<Vec3> nodes(12);
    for (int k = 0; k < 12; ++k) nodes[static_cast<std::size_t>(k)] = Vec3(0.5 * k - 3.0, 0.4 * k - 2.0, 5.0 + 4.0 * k);
    const PointBinding riding = bind_points(model, nodes, 12, false);
    for (std::size_t i = 0; i < nodes.size(); ++i)
        ASSERT_NEAR((evaluate(riding, i, model.rest) - nodes[i]).norm(), 0.0, 1e-9);
    EXPECT_LE(riding.largest_weight(), 1.0);
    std::printf("centre-line: largest weight %.3f\n", riding.largest_weight());
}

TEST(Binding, AnInflatedTubeCarriesItsCentreLineNowhere) {
    const SoftBodyModel model = rig::free_tube();
    const std::vector<Vec3> nodes{Vec3(0, 0, 30)};
    const PointBinding riding = bind_points(model, nodes, 24, false);
    std::vector<Vec3> x;
    for (const Vec3& p : model.rest) x.emplace_back(1.2 * p.x(), 1.2 * p.y(), p.z());
    EXPECT_NEAR((evaluate(riding, 0, x) - nodes[0]).norm(), 0.0, 1e-9);
}

TEST(Binding, APointBesideAPlaneOfParticlesIsRefusedWithASentence) {
    SoftBodyModel flat;
    for (int i = 0; i < 5; ++i)
        for (int j = 0; j < 5; ++j) flat.rest.emplace_back(2.0 * i, 2.0 * j, 0.0);
    flat.normal.assign(25, Vec3::UnitZ());
    const std::vector<Vec3> in_plane{Vec3(3, 3, 0)}, beside{Vec3(3, 3, 0.5)};
    const PointBinding good = bind_points(flat, in_plane, 8, false);
    EXPECT_NEAR((evaluate(good, 0, flat.rest) - in_plane[0]).norm(), 0.0, 1e-12);
    try {
        bind_points(flat, beside, 8, false);
        FAIL() << "a point beside a plane was bound";
    } catch (const UserError& e) {
        EXPECT_NE(std::string(e.what()).find("one plane"), std::string::npos) << e.what();
    }
}

TEST(Binding, APointNeverUsesTheParticlesOfTheVesselNextDoor) {
    // Two tubes of radius 5 whose walls are 0.8 mm apart, with particles 2.1 mm apart: the nearest particle of a vertex
    // may well be the neighbour's, but its wall faces the other way.
    WallSample both = rig::sample(5.0, 40.0, true);
    const std::size_t split = both.position.size();
    WallSample other = rig::sample(5.0, 40.0, true);
    for (std::size_t i = 0; i < split; ++i) {
        both.position.push_back(other.position[i] + Vec3(10.8, 0, 0));
        both.normal.push_back(other.normal[i]);
        both.area_mm2.push_back(other.area_mm2[i]);
        both.thickness_mm.push_back(other.thickness_mm[i]);
        both.region.push_back(1);
    }
    for (const auto& [a, b] : other.links)
        both.links.emplace_back(a + static_cast<Index>(split), b + static_cast<Index>(split));
    const SoftBodyModel model = build_soft_body(both, {}, nullptr);
    const Surface lumen = surface(5.0, 40.0);
    const PointBinding binding = bind_points(model, lumen.mesh.vertices, 10, true, lumen.normals);
    for (const Index j : binding.particle) ASSERT_LT(static_cast<std::size_t>(j), split);
}

}  // namespace
}  // namespace cathlab
