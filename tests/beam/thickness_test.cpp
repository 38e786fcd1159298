#include "beam/thickness.h"

#include <gtest/gtest.h>

#include <cmath>

#include "beam/materials.h"
#include "core/errors.h"

using namespace cathlab;

namespace {
TriMesh box(const Vec3& low, const Vec3& high) {
    TriMesh mesh;
    for (int i = 0; i < 8; ++i)
        mesh.vertices.emplace_back((i & 1 ? high : low).x(), (i & 2 ? high : low).y(), (i & 4 ? high : low).z());
    for (const Triangle& t : {Triangle(0, 2, 1), Triangle(1, 2, 3), Triangle(4, 5, 6), Triangle(5, 7, 6),
                              Triangle(0, 1, 4), Triangle(1, 5, 4), Triangle(2, 6, 3), Triangle(3, 6, 7),
                              Triangle(0, 4, 2), Triangle(2, 4, 6), Triangle(1, 3, 5), Triangle(3, 7, 5)})
        mesh.triangles.push_back(t);
    return mesh;
}
}  // namespace

TEST(Thickness, ALineThroughABoxMeasuresItEvenThroughEdgesAndCorners) {
    const TriMesh mesh = box(Vec3(-10, -20, -30), Vec3(10, 20, 30));
    ASSERT_TRUE(find_faults(mesh).sound());
    ASSERT_GT(signed_volume(mesh), 0.0);
    EXPECT_NEAR(path_length(mesh, Vec3(0, -500, 0), Vec3::UnitY()), 40.0, 1e-9);  // hits the diagonals of both faces
    EXPECT_NEAR(path_length(mesh, Vec3(3, 4, -500), Vec3::UnitZ()), 60.0, 1e-9);
    EXPECT_NEAR(path_length(mesh, Vec3(-50, -100, -150), Vec3(1, 2, 3)), std::sqrt(20. * 20 + 40 * 40 + 60 * 60),
                1e-9);                                                             // corners
    EXPECT_NEAR(path_length(mesh, Vec3(0, -500, 0), Vec3(0.1, 1, 0)), 0.0, 1e-9);  // misses
    const double slant = std::cos(0.3);
    EXPECT_NEAR(path_length(mesh, Vec3(0, -20, 0), Vec3(std::sin(0.3), slant, 0)),
                std::min(40.0 / slant, 10.0 / std::sin(0.3)), 1e-9);
}

TEST(Thickness, NestedMediaAreDifferences) {
    const TriMesh body = box(Vec3(-150, -100, -200), Vec3(150, 100, 200)),
                  lung = box(Vec3(-60, -50, -80), Vec3(60, 50, 80));
    const std::vector<BodySolid> solids = {{&body, "soft_tissue", ""}, {&lung, "lung", "soft_tissue"}};
    const CArmSpec spec;
    const CArmPose pose = c_arm_pose(spec, Vec3::Zero(), 0.0, 0.0);
    const auto mu = [](const char* name) { return attenuation_per_mm(material(name), 60.0, TableReading::straight); };
    const double expected = (100.0 * mu("soft_tissue") + 100.0 * mu("lung")) / mu("water");
    // Four of the five rays are inclined by 40 mm in 1050.
    const double slant = (1.0 + 4.0 * std::sqrt(1.0 + std::pow(40.0 / 1050.0, 2))) / 5.0;
    EXPECT_NEAR(BodyThickness(solids).water_mm(spec, pose), expected * slant, 1e-9);
    EXPECT_GT(BodyThickness(solids).water_mm(spec, c_arm_pose(spec, Vec3::Zero(), 30.0, 0.0)), expected * slant);
    EXPECT_EQ(BodyThickness().water_mm(spec, pose), 0.0);
}

TEST(Thickness, AnUnknownMaterialIsNamed) {
    const TriMesh body = box(Vec3(-1, -1, -1), Vec3(1, 1, 1));
    const std::vector<BodySolid> solids = {{&body, "soft_tisue", ""}};
    EXPECT_THROW(BodyThickness{solids}, UserError);
}
