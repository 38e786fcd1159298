// The pieces of wall that rigs load: surfaces that are sound, forces that are what they are said to be.
#include "calibrate/specimen.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/errors.h"
#include "core/units.h"
#include "scene/temporary_folder.h"

namespace cathlab {
namespace {

WallRig rig_of(RigKind kind, RigStress stress = RigStress::nominal) {
    WallRig rig;
    rig.kind = kind;
    rig.stress = stress;
    rig.thickness_mm = 1.5;
    if (kind == RigKind::ring) rig.shape.length_mm = 10.0;
    if (kind == RigKind::block) rig.length_mm = rig.width_mm = 30.0;
    return rig;
}

const std::vector<RigKind>& kinds() {
    static const std::vector<RigKind> all{RigKind::tube, RigKind::ring, RigKind::strip, RigKind::block};
    return all;
}

double area(const WallSample& sample) {
    double sum = 0.0;
    for (const double a : sample.area_mm2) sum += a;
    return sum;
}

Vec3 total(const std::vector<Vec3>& forces) {
    Vec3 sum = Vec3::Zero();
    for (const Vec3& f : forces) sum += f;
    return sum;
}

TEST(Specimen, TheTrianglesOfEveryRigAreASurfaceThatLooksOutward) {
    for (const RigKind kind : kinds()) {
        const Specimen specimen = make_specimen(rig_of(kind), SceneWall{});
        const WallSample& sample = specimen.sample;
        ASSERT_FALSE(sample.triangles.empty());
        const MeshFaults faults = find_faults({sample.position, sample.triangles});
        EXPECT_EQ(faults.non_manifold_edges, 0U) << rig_name(kind);
        EXPECT_EQ(faults.degenerate_triangles, 0U) << rig_name(kind);
        for (const Triangle& t : sample.triangles) {
            const auto corner = [&](int k) { return sample.position[static_cast<std::size_t>(t[k])]; };
            const Vec3 normal = (corner(1) - corner(0)).cross(corner(2) - corner(0));
            const Vec3 middle = (corner(0) + corner(1) + corner(2)) / 3.0;
            const Vec3 outward = specimen.gauges[0].radius_mm > 0.0 ? Vec3(middle.x(), middle.y(), 0.0) : Vec3::UnitZ();
            EXPECT_GE(normal.dot(outward), -1e-9) << rig_name(kind) << " at " << middle.transpose();
        }
    }
}

TEST(Specimen, AFreeEdgeStandsWhereThePieceEnds) {
    const WallRig ring = rig_of(RigKind::ring), strip = rig_of(RigKind::strip);
    EXPECT_NEAR(area(make_specimen(ring, SceneWall{}).sample), 2.0 * units::pi * 12.0 * 10.0, 0.01 * 754.0);
    EXPECT_NEAR(area(make_specimen(strip, SceneWall{}).sample), 60.0 * 12.0, 1e-9);
    const TriMesh sheet = sheet_mesh(20.0, 5.0, 2.0);
    EXPECT_NEAR(surface_area(sheet), 100.0, 1e-9);
    EXPECT_EQ(find_faults(sheet).non_manifold_edges, 0U);
}

TEST(Specimen, AStripIsPulledByItsStressOnItsSection) {
    const Specimen strip = make_specimen(rig_of(RigKind::strip), SceneWall{});
    EXPECT_NEAR(total(strip.gauges[0].push).x(), 12.0 * 1.5, 1e-12);  // mN a kPa
    EXPECT_NEAR(total(strip.gauges[0].push).y(), 0.0, 1e-12);
    const Specimen block = make_specimen(rig_of(RigKind::block), SceneWall{});
    EXPECT_NEAR(total(block.gauges[0].push).norm(), 0.0, 1e-12);
    double pulled = 0.0;
    for (const Vec3& f : block.gauges[0].push) pulled += std::max(0.0, f.x());
    EXPECT_NEAR(pulled, 30.0 * 1.5, 1e-12);
}

TEST(Specimen, TheLoadOfARingIsThatOfThePressureAndPushesItNowhere) {
    const Specimen ring = make_specimen(rig_of(RigKind::ring), SceneWall{});
    EXPECT_NEAR(total(ring.gauges[0].push).norm(), 0.0, 1e-9);
    double outward = 0.0;
    for (const Vec3& f : ring.gauges[0].push) outward += f.norm();
    EXPECT_NEAR(outward, 2.0 * units::pi * 10.0 * 1.5, 0.01 * 94.0);  // p = sigma t / r over 2 pi r w
    const Specimen paper = make_specimen(rig_of(RigKind::ring, RigStress::paper), SceneWall{});
    EXPECT_NEAR(paper.gauges[0].push[7].norm() / ring.gauges[0].push[7].norm(), 12.0 / 1.5, 1e-9);
}

TEST(Specimen, AnEvenStretchIsReadAsItIsWhereverThePieceStands) {
    for (const RigKind kind : kinds()) {
        const Specimen specimen = make_specimen(rig_of(kind), SceneWall{});
        std::vector<Vec3> x = specimen.sample.position;
        EXPECT_NEAR(specimen.gauges[0].strain(x), 0.0, 1e-12) << rig_name(kind);
        for (Vec3& p : x) p = Vec3(1.2 * p.x(), 1.2 * p.y(), 0.9 * p.z()) + Vec3(3.0, -2.0, 1.0);
        EXPECT_NEAR(specimen.gauges[0].strain(x), 0.2, 2e-4) << rig_name(kind);
    }
}

TEST(Specimen, GuidesLeaveABlockStretchAndWidthAlone) {
    const Specimen block = make_specimen(rig_of(RigKind::block), SceneWall{});
    std::vector<Vec3> x = block.sample.position, v(x.size(), Vec3(1.0, 2.0, 3.0));
    for (Vec3& p : x) p = Vec3(0.8 * p.x() + 0.1 * p.y(), 1.1 * p.y(), 0.3 * p.x()) + Vec3(3.0, -2.0, 1.0);
    block.guide(x, v);
    EXPECT_NEAR(block.gauges[0].strain(x), -0.2, 2e-3);
    for (std::size_t i = 0; i < x.size(); ++i) {
        EXPECT_EQ(x[i].z(), 0.0);
        EXPECT_NEAR(v[i].norm(), 0.0, 1e-9);
    }
    const std::vector<Vec3> once = x;
    block.guide(x, v);
    for (std::size_t i = 0; i < x.size(); ++i) EXPECT_NEAR((x[i] - once[i]).norm(), 0.0, 1e-12);
}

TEST(Specimen, SizesThatMakeNoRigAreToldAsTheUsers) {
    const auto sentence = [](const WallRig& rig) { return error_sentence([&] { make_specimen(rig, SceneWall{}); }); };
    WallRig rig = rig_of(RigKind::tube);
    rig.shape.radius_mm = 0.0;
    EXPECT_NE(sentence(rig).find("radius is 0"), std::string::npos) << sentence(rig);
    rig = rig_of(RigKind::ring);
    rig.shape.radius_mm = std::nan("");
    EXPECT_NE(sentence(rig).find("radius"), std::string::npos) << sentence(rig);
    rig = rig_of(RigKind::tube);
    rig.thickness_mm = -1.0;
    EXPECT_NE(sentence(rig).find("thickness"), std::string::npos) << sentence(rig);
    rig.thickness_mm = 1.0;
    rig.shape.length_mm = 20.0;
    EXPECT_NE(sentence(rig).find("three radii"), std::string::npos) << sentence(rig);
    rig = rig_of(RigKind::strip);
    rig.length_mm = 20.0;
    EXPECT_NE(sentence(rig).find("three widths"), std::string::npos) << sentence(rig);
    for (const RigKind kind : {RigKind::strip, RigKind::block})
        EXPECT_NE(sentence(rig_of(kind, RigStress::paper)).find("of a round wall"), std::string::npos);
}

}  // namespace
}  // namespace cathlab
