// Every guidewire and passive catheter of assets/devices against beam theory over its own sections.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "core/errors.h"
#include "rod/rod_fixture.h"
#include "rod/sectioned_beam.h"
#include "scene/device_file.h"
#include "scene/load_scene.h"

namespace cathlab {
namespace {

// Guidewires, and passive catheters as the tubes that they are.
std::vector<std::string> wires() {
    const std::string folder = std::string(CATHLAB_SOURCE_DIR) + "/assets/devices/";
    std::vector<std::string> found;
    for (const std::string& name : names_in_folder(folder, ".toml"))
        if (device_kind(folder + name + ".toml") != "catheter") found.push_back(name);
    return found;
}

WireSpec load(const std::string& name) {
    const std::string path = std::string(CATHLAB_SOURCE_DIR) + "/assets/devices/" + name + ".toml";
    return device_kind(path) == "wire" ? load_wire(path) : as_wire(load_sleeve(path));
}

/// The wire as it stands in its file, but straight: beam theory is that of a straight beam.
WireSpec straight(const std::string& name) {
    WireSpec spec = load(name);
    for (WireSection& section : spec.sections) section.rest_curvature_per_mm = 0.0;
    return spec;
}

class Preset : public testing::TestWithParam<std::string> {};

TEST_P(Preset, ACantileverDropsAsTheBeamEquationSays) {
    const WireSpec spec = straight(GetParam());
    for (const double insertion : {60.0, 151.3, 300.7}) {
        Rod rod(spec, {}, insertion);
        const double begin = 0.5 * rod.link_length(0);  // a force acts on a link's centre
        const double per_mn = test::drop_per_mn(spec, begin, insertion), expected = 0.01 * (insertion - begin);
        test::settle(rod, 0, Vec3(expected / per_mn, 0.0, 0.0), 0.5, 60);
        const double drop = rod.link_pose(0).position.x();
        std::printf("%s: %.0f mm out: drops %.4f mm of %.4f, %+.2f %%\n", GetParam().c_str(), insertion, drop, expected,
                    100.0 * (drop / expected - 1.0));
        EXPECT_NEAR(drop, expected, 0.01 * expected) << insertion << " mm out";
    }
}

TEST_P(Preset, ALargeBendFollowsTheElasticaToSixtyPercentOfTheLength) {
    const WireSpec spec = straight(GetParam());
    const double insertion = 151.3;
    for (const double share : {0.3, 0.6}) {
        Rod rod(spec, {}, insertion);
        const double begin = 0.5 * rod.link_length(0), arm = insertion - begin;
        const double load = test::load_for_drop(spec, begin, insertion, share);
        const test::Elastica expected = test::elastica(spec, begin, insertion, load);
        for (int ramp = 1; ramp <= 10; ++ramp) test::settle(rod, 0, Vec3(0.0, 0.1 * ramp * load, 0.0), 0.2, 20);
        test::settle(rod, 0, Vec3(0.0, load, 0.0), 0.2, 200);
        const Vec3 found = rod.link_pose(0).position;
        std::printf("%s: elastica %.0f %%: across %+.2f %%, along %+.2f %%\n", GetParam().c_str(), 100.0 * share,
                    100.0 * (found.y() / expected.across - 1.0),
                    100.0 * ((arm - found.z()) / (arm - expected.axial) - 1.0));
        EXPECT_NEAR(found.y(), expected.across, 0.02 * expected.across);
        EXPECT_NEAR(arm - found.z(), arm - expected.axial, 0.02 * (arm - expected.axial));
    }
}

TEST_P(Preset, ItBucklesAtTheEulerLoadOfItsSections) {
    const WireSpec spec = straight(GetParam());
    const double insertion = 120.0;
    Rod sample(spec, {}, insertion);
    const double begin = 0.5 * sample.link_length(0), load = test::euler_load(spec, begin, insertion);
    const auto sway = [&](double share) {
        Rod rod(spec, {}, insertion);
        test::settle(rod, 0, Vec3(1e-6 * load, 0.0, -share * load), 4.0, 400);
        return rod.link_pose(0).position.x();
    };
    const double below = sway(0.97), above = sway(1.03);
    std::printf("%s: Euler %.3f mN: sways %.2g mm at 97 %%, %.2g mm at 103 %%\n", GetParam().c_str(), load, below,
                above);
    EXPECT_LT(std::fabs(below), 0.05);
    EXPECT_GT(std::fabs(above), 1.0);
}

TEST_P(Preset, ItTwistsAndStretchesByTheSumOfItsSections) {
    const WireSpec spec = straight(GetParam());
    const double insertion = 200.0, angle = 0.2, h = 0.1;
    Rod rod(spec, {}, insertion);
    for (int i = 0; i < 200; ++i) {  // two points of link 0 at +-1 mm on its x axis are held on a line turned by angle
        rod.command(0.0, 0.0);
        rod.predict(h);
        for (int k = 0; k < 2; ++k) {
            std::vector<ChainRow> rows;
            for (const double side : {1.0, -1.0}) {
                ChainRow row;
                row.bilateral = true;
                row.compliance = 1e-9;
                row.arm = rod.link_pose(0).orientation * Vec3(side, 0.0, 0.0);
                row.normal = Vec3(-std::sin(angle), std::cos(angle), 0.0);
                row.gap = (rod.link_pose(0).position + row.arm).dot(row.normal);
                rows.push_back(row);
            }
            rod.solve(h, rows);
        }
        rod.finish(h);
    }
    const double begin = 0.5 * rod.link_length(0);
    const auto one = [](double) { return 1.0; };
    const double torque =
        angle / test::over_compliance(spec, begin, insertion, &WireSection::torsion_stiffness_n_mm2, one);
    EXPECT_NEAR(-rod.sheath_torque_mn_mm(), torque, 0.01 * torque);

    Rod pulled(spec, {}, insertion);
    const double z = pulled.link_pose(0).position.z();
    test::settle(pulled, 0, Vec3(0.0, 0.0, 1000.0), 0.5, 100);
    const double longer = 1000.0 * test::over_compliance(spec, begin, insertion, &WireSection::axial_stiffness_n, one);
    EXPECT_NEAR(pulled.link_pose(0).position.z() - z, longer, 0.01 * longer);
}

TEST_P(Preset, UnloadedItTakesTheShapeThatItsSectionsSay) {
    const WireSpec spec = load(GetParam());
    const double insertion = 150.0;
    Rod rod(spec, {}, insertion);
    for (int i = 0; i < 150; ++i) test::substep(rod, 0.2);
    // From the mouth to the tip: z inward, bent towards y by each section's own curvature.
    double angle = 0.0, y = 0.0, z = 0.0;
    const int pieces = 15000;
    for (int i = 0; i < pieces; ++i) {
        const double ds = insertion / pieces, s = insertion - (i + 0.5) * ds;
        angle += ds * test::section_at(spec, s).rest_curvature_per_mm;
        y += ds * std::sin(angle);
        z += ds * std::cos(angle);
    }
    std::printf("%s: tip turned by %.0f deg\n", GetParam().c_str(), angle * 57.29578);
    EXPECT_NEAR(std::fabs(rod.tip().y()), y, 0.2);
    EXPECT_NEAR(rod.tip().z(), z, 0.2);
    EXPECT_NEAR(rod.tip().x(), 0.0, 1e-6);
    EXPECT_LT(rod.energy_uj(), 1e-3);
    // Turned at the sheath by a right angle it bends to the side instead.
    for (int i = 0; i < 100; ++i) test::substep(rod, 0.02, {}, {}, 0.0, 0.01 * 1.5707963);
    for (int i = 0; i < 150; ++i) test::substep(rod, 0.2);
    EXPECT_NEAR(std::fabs(rod.tip().x()), y, 0.2);
    EXPECT_NEAR(rod.tip().y(), 0.0, 0.2);
}

INSTANTIATE_TEST_SUITE_P(EveryWire, Preset, testing::ValuesIn(wires()), [](const auto& info) {
    std::string name = info.param;
    for (char& c : name)
        if (c == '-') c = '_';
    return name;
});

}  // namespace
}  // namespace cathlab
