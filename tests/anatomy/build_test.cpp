#include "anatomy/build.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "adult.h"
#include "anatomy/implicit_tree.h"
#include "anatomy/remesh.h"
#include "core/winding.h"

namespace cathlab {
namespace {

constexpr double pi = 3.14159265358979323846;

double nearest_vertex(const TriMesh& mesh, const Vec3& p) {
    double best = 1e300;
    for (const Vec3& v : mesh.vertices) best = std::min(best, (v - p).norm());
    return best;
}

void expect_error(const AnatomySpec& spec, const std::string& word) {
    try {
        build_anatomy(spec);
        FAIL() << "no error that names '" << word << "'";
    } catch (const UserError& e) {
        EXPECT_NE(std::string(e.what()).find(word), std::string::npos) << e.what();
    }
}

TEST(Anatomy, AStraightTubeHoldsItsVolume) {
    const AnatomyModel model = build_anatomy(test::straight_tube(5.0, 80.0), Workers(2));
    const double want = pi * 25.0 * 80.0;
    EXPECT_NEAR(signed_volume(model.fine) / want, 1.0, 0.01);
    EXPECT_NEAR(signed_volume(model.lumen) / want, 1.0, 0.015);
    for (const TriMesh* mesh : {&model.fine, &model.lumen}) {
        EXPECT_TRUE(find_faults(*mesh).sound());
        const MeshQuality q = measure_quality(*mesh);
        EXPECT_EQ(q.genus, 0);
        EXPECT_EQ(q.components, 1);
        EXPECT_GT(q.smallest_angle_deg, 15.0);
    }
    EXPECT_NEAR(static_cast<double>(model.lumen.triangles.size()), 3000.0, 300.0);
}

TEST(Anatomy, ThePartsOfAModelAgreeInSize) {
    const AnatomyModel m = build_anatomy(test::fork(), Workers(2));
    EXPECT_EQ(m.fine.vertices.size(), m.fine_region.size());
    EXPECT_EQ(m.fine.vertices.size(), m.fine_radius.size());
    EXPECT_EQ(m.lumen.vertices.size(), m.lumen_region.size());
    EXPECT_EQ(m.lumen.vertices.size(), m.lumen_radius.size());
    EXPECT_EQ(m.centreline.edges.size() + 1, m.centreline.nodes.size());
    EXPECT_EQ(measure_quality(m.lumen).genus, 0);
}

TEST(Anatomy, AStenosisNarrowsTheLumenByItsDegree) {
    AnatomySpec spec = test::straight_tube(4.0, 60.0);
    spec.stenoses.push_back({"tube", 30.0, 16.0, 0.6, {}});
    spec.meshing.voxel_mm = 0.5;
    const AnatomyModel model = build_anatomy(spec, Workers(2));
    double narrowest = 1e300;
    double elsewhere = 0.0;
    for (const Vec3& p : model.fine.vertices) {
        const double r = std::hypot(p.x(), p.y());
        if (std::fabs(p.z() - 30.0) < 2.0) narrowest = std::min(narrowest, r);
        if (p.z() > 10.0 && p.z() < 20.0) elsewhere = std::max(elsewhere, r);
    }
    EXPECT_NEAR(narrowest, 4.0 * 0.4, 0.05);
    EXPECT_NEAR(elsewhere, 4.0, 0.08);
}

TEST(Anatomy, ATubeHasTheTrianglesThatWereAskedForHoweverItIsPutTogether) {
    // Straight as a ruler and fine-grained: the shape that invites slivers as long as the tube.
    AnatomySpec one = test::straight_tube(5.0, 75.0);
    one.meshing.voxel_mm = 0.5;
    AnatomySpec two = one;
    two.vessels.push_back(two.vessels.front());
    two.vessels.back().name = "back";
    two.vessels.back().parent = "tube";
    two.vessels.back().points = {{0.0, 0.0, 0.0, 5.0}, {0.0, 0.0, -60.0, 5.0}};
    two.entries.clear();
    for (AnatomySpec* spec : {&one, &two})
        for (const int wanted : {2400, 6000}) {
            spec->meshing.face_count = wanted;
            const auto got = static_cast<double>(build_anatomy(*spec, Workers(2)).lumen.triangles.size());
            EXPECT_NEAR(got, wanted, 0.1 * wanted) << spec->vessels.size() << " vessels";
        }
}

TEST(Anatomy, ThreadsDoNotChangeAModel) {
    EXPECT_EQ(model_hash(build_anatomy(test::fork(), Workers(1))), model_hash(build_anatomy(test::fork(), Workers(3))));
}

TEST(Anatomy, ImpossibleVesselsAreTheUsersErrors) {
    AnatomySpec spec = test::straight_tube(5.0, 80.0);
    spec.vessels[0].points[1] = spec.vessels[0].points[0];
    expect_error(spec, "needs a length");
    spec = test::straight_tube(5.0, 80.0);
    spec.vessels[0].points[1][3] = -1.0;
    expect_error(spec, "radius");
    spec.vessels[0].points[1][3] = std::numeric_limits<double>::quiet_NaN();
    expect_error(spec, "radius");
    spec = test::straight_tube(5.0, 80.0);
    spec.vessels[0].points[0][1] = std::numeric_limits<double>::infinity();
    expect_error(spec, "finite");
    spec = test::fork();
    spec.vessels[1].parent = "tubes";
    expect_error(spec, "did you mean 'tube'");
    spec = test::straight_tube(5.0, 80.0);
    spec.vessels[0].points.pop_back();
    expect_error(spec, "at least 2");
    spec = test::straight_tube(5.0, 80.0);
    spec.meshing.face_count = 100;
    expect_error(spec, "too few");
    spec = test::straight_tube(5.0, 80.0);
    spec.stenoses.push_back({"tube", 40.0, 10.0, 0.9, {}});
    expect_error(spec, "voxel_mm");
    spec.stenoses[0].place_mm = 90.0;
    expect_error(spec, "beyond the end");
    expect_error(AnatomySpec{}, "no vessel");
}

TEST(Anatomy, VesselsThatTouchAwayFromTheirBranchAreRefused) {
    AnatomySpec spec = test::fork();
    VesselSpec stray;
    stray.name = "stray";
    stray.parent = "left";
    stray.region = "tube";
    stray.points = {{14.0, 0.0, 60.0, 2.0}, {0.0, 0.0, 62.0, 2.0}, {-14.0, 0.0, 60.0, 2.0}};
    spec.vessels.push_back(stray);
    expect_error(spec, "come within");
}

/// Curves of a tree near each other but unrelated by a branch.
TEST(ImplicitTree, TheGradientIsTheSlopeOfTheValue) {
    ImplicitTree::Vessel a;
    a.curve = {{Vec3(0, 0, 0), Vec3(0, 0, 20)}, {4.0, 4.0}, {0.0, 20.0}};
    ImplicitTree::Vessel b;
    b.curve = {{Vec3(0, 0, 10), Vec3(15, 0, 14)}, {2.0, 2.0}, {0.0, 15.5}};
    ImplicitTree::Branch branch;
    branch.trunk = {0};
    branch.children = {1};
    branch.center = Vec3(0, 0, 10);
    branch.blend_mm = 1.5;
    branch.inner = 30.0;
    branch.outer = 40.0;
    const ImplicitTree tree({a, b}, {branch}, {}, 5.0);
    const Vec3 p(4.6, 0.9, 13.6);
    const FieldSample s = tree.sample(p);
    for (int k = 0; k < 3; ++k) {
        Vec3 d = Vec3::Zero();
        d[k] = 1e-5;
        EXPECT_NEAR((tree.sample(p + d).value - tree.sample(p - d).value) / 2e-5, s.gradient[k], 1e-5);
    }
    EXPECT_LT(s.value, std::min(tree.vessel_distance(p, 0), tree.vessel_distance(p, 1)));  // rounded
}

TEST(Remesh, EdgesTakeTheWantedLength) {
    AnatomySpec spec = test::straight_tube(6.0, 40.0);
    const TriMesh tube = build_anatomy(spec).lumen;
    RemeshGoal goal;
    goal.size = [](const Vec3& p) { return p.z() < 20.0 ? 1.0 : 2.0; };
    const TriMesh mesh = remesh(tube, goal, Workers(1));
    EXPECT_TRUE(find_faults(mesh).sound());
    double sum[2] = {0.0, 0.0};
    double count[2] = {0.0, 0.0};
    for (const Triangle& t : mesh.triangles) {
        for (int k = 0; k < 3; ++k) {
            const Vec3& a = mesh.vertices[static_cast<std::size_t>(t[k])];
            const Vec3& b = mesh.vertices[static_cast<std::size_t>(t[(k + 1) % 3])];
            if (std::min(std::fabs(a.z() - 20.0), std::fabs(b.z() - 20.0)) < 4.0) continue;
            sum[a.z() < 20.0 ? 0 : 1] += (a - b).norm();
            count[a.z() < 20.0 ? 0 : 1] += 1.0;
        }
    }
    EXPECT_NEAR(sum[0] / count[0], 1.0, 0.15);
    EXPECT_NEAR(sum[1] / count[1], 2.0, 0.3);
}

TEST(Winding, TheTestsOwnMeasureKnowsInsideFromOutside) {
    const TriMesh tube = build_anatomy(test::straight_tube(5.0, 40.0)).lumen;
    EXPECT_NEAR(winding(tube, Vec3(0, 0, 20)), 1.0, 1e-6);
    EXPECT_NEAR(winding(tube, Vec3(9, 0, 20)), 0.0, 1e-6);
    EXPECT_NEAR(nearest_vertex(tube, Vec3(0, 0, 20)), 5.0, 0.2);
}

}  // namespace
}  // namespace cathlab
