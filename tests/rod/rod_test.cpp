// The wire in its sheath: feeding in and out, turning, placement, repeatability, bad input.
#include "rod/rod.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/errors.h"
#include "core/hash.h"
#include "core/units.h"
#include "rod_fixture.h"

namespace cathlab {
namespace {

using test::substep;

TEST(Sheath, LinksEnterWithoutAJump) {
    // A bent wire is fed in slowly past several links; from substep to substep nothing may jump.
    Rod rod(test::amplatz(), {}, 100.0);
    std::vector<Vec3> load{Vec3(20.0, 0.0, 0.0)};
    test::settle(rod, 0, load[0]);
    const double h = 0.02, advance = 0.05;
    for (int i = 0; i < 200; ++i) substep(rod, h, load, {}, advance);
    Vec3 tip = rod.tip(), step = Vec3::Zero();
    double energy = rod.energy_uj(), energy_step = 0.0;
    std::size_t entered = rod.free_link_count();
    for (int i = 0; i < 400; ++i) {
        substep(rod, h, load, {}, advance);
        const Vec3 step_now = rod.tip() - tip;
        const double energy_step_now = rod.energy_uj() - energy;
        if (i > 0) {
            EXPECT_LT((step_now - step).norm(), 0.01) << "substep " << i << ", insertion " << rod.insertion_mm();
            EXPECT_LT(std::fabs(energy_step_now - energy_step), 0.01 * energy) << "insertion " << rod.insertion_mm();
        }
        step = step_now;
        energy_step = energy_step_now;
        tip = rod.tip();
        energy = rod.energy_uj();
    }
    EXPECT_GE(rod.free_link_count(), entered + 6);
}

TEST(Sheath, InAndOutAgainLeavesTheWireWhereItWas) {
    Rod rod(test::bmw(), {}, 80.0);
    const Vec3 tip = rod.tip();
    for (int i = 0; i < 500; ++i) substep(rod, 0.004, {}, {}, 0.4, 0.02);
    EXPECT_NEAR(rod.insertion_mm(), 280.0, 1e-9);
    EXPECT_NEAR((rod.tip() - tip).z(), 200.0, 0.05);
    for (int i = 0; i < 500; ++i) substep(rod, 0.004, {}, {}, -0.4, -0.02);
    for (int i = 0; i < 100; ++i) substep(rod, 0.1);
    EXPECT_NEAR((rod.tip() - tip).norm(), 0.0, 1e-6);
}

TEST(Sheath, InsertionStopsAtBothEnds) {
    Rod rod(test::bmw(), {}, 30.0);
    for (int i = 0; i < 200; ++i) substep(rod, 0.004, {}, {}, -0.4);
    EXPECT_DOUBLE_EQ(rod.insertion_mm(), rod.min_insertion_mm());
    EXPECT_LT(rod.min_insertion_mm(), 7.0);
    for (int i = 0; i < 1800; ++i) substep(rod, 0.004, {}, {}, 0.4);
    EXPECT_DOUBLE_EQ(rod.insertion_mm(), rod.max_insertion_mm());
    EXPECT_GT(rod.max_insertion_mm(), 590.0);
    EXPECT_TRUE(std::isfinite(rod.tip().squaredNorm()));
}

TEST(Sheath, ATurnAtTheSheathReachesTheFreeTip) {
    Rod rod(test::bmw(), {}, 200.0);
    for (int i = 0; i < 100; ++i) substep(rod, 0.004, {}, {}, 0.0, 0.025);
    for (int i = 0; i < 100; ++i) substep(rod, 0.1);
    const Vec3 side = rod.link_pose(0).orientation * Vec3::UnitX();
    EXPECT_NEAR(side.x(), std::cos(2.5), 1e-6);
    EXPECT_NEAR(side.y(), std::sin(2.5), 1e-6);
    EXPECT_NEAR(rod.rotation_rad(), 2.5, 1e-12);
}

TEST(Sheath, TheTwistUnderATorqueIsMomentTimesLengthOverGJ) {
    // A couple of rows on the tip's link: two points at +-a on its x axis pushed by friction-free rows along +-y.
    const WireSpec spec = test::amplatz();
    Rod rod(spec, {}, 200.0);
    const double angle = 0.2;
    ChainRow row;
    row.bilateral = true;
    row.compliance = 1e-9;
    const double h = 0.1;
    for (int i = 0; i < 300; ++i) {
        rod.command(0.0, 0.0);
        rod.predict(h);
        std::vector<ChainRow> rows;
        for (int k = 0; k < 2; ++k) {
            const Pose pose = rod.link_pose(0);
            rows.clear();
            for (const double side : {1.0, -1.0}) {
                row.arm = pose.orientation * Vec3(side, 0.0, 0.0);
                row.normal = Vec3(-std::sin(angle), std::cos(angle), 0.0);
                row.gap = (pose.position + row.arm).dot(row.normal);
                rows.push_back(row);
            }
            rod.solve(h, rows);
        }
        rod.finish(h);
    }
    const double length = 200.0 - 0.5 * rod.link_length(0);
    const double expected = -angle * spec.sections[0].torsion_stiffness_n_mm2 * 1000.0 / length;
    EXPECT_NEAR(rod.sheath_torque_mn_mm(), expected, 0.01 * std::fabs(expected));
}

TEST(Sheath, PushingFiveNewtonHardlyStretches) {
    // The tip stands against a stop; the hand pushes and pulls at 5 N.  The chain opens by F / EA and no more.
    Rod rod(test::amplatz(), {}, 60.0);
    for (const double sign : {1.0, -1.0}) {
        test::settle(rod, 0, Vec3(0.0, 0.0, sign * 5000.0), 0.1, 100);
        EXPECT_LT(rod.max_stretch(), 1e-3);
        EXPECT_NEAR(rod.sheath_force_mn(), -sign * 5000.0, 0.5);
    }
}

TEST(Placement, FollowsThePathWithoutStretch) {
    std::vector<Vec3> path;
    for (int i = 1; i <= 200; ++i) {
        const double a = 0.0157 * i;
        path.push_back(Vec3(60.0 * (1.0 - std::cos(a)), 0.0, 40.0 + 60.0 * std::sin(a)));
    }
    path.insert(path.begin(), Vec3(0.0, 0.0, 40.0));
    SheathPose sheath;
    const Rod rod(test::bmw(), sheath, 200.0, path);
    EXPECT_LT(rod.max_stretch(), 1e-9);
    const std::vector<Vec3> line = rod.polyline();
    for (std::size_t i = 0; i < rod.free_link_count(); ++i) {
        if (line[i].z() < 40.0) continue;
        EXPECT_NEAR((line[i] - Vec3(60.0, 0.0, 40.0)).norm(), 60.0, 0.01);
    }
    std::vector<RodSample> samples;
    rod.samples(1.0, samples);
    for (std::size_t i = 1; i < samples.size(); ++i) {
        EXPECT_LE((samples[i].position - samples[i - 1].position).norm(), 1.0 + 1e-9);
        EXPECT_GT((samples[i].position - samples[i - 1].position).norm(), 1e-3);
    }
    EXPECT_LT((samples.front().position - rod.tip()).norm(), 1e-12);
    EXPECT_LT(samples.back().position.norm(), 1.0 + 1e-9);
}

TEST(Placement, ARestCurvatureBendsTheFreeTip) {
    WireSpec spec = test::bmw();
    WireSection tip = spec.sections[0];
    tip.length_mm = 30.0;
    tip.rest_curvature_per_mm = 0.05;
    tip.link_length_mm = 1.5;
    spec.sections.insert(spec.sections.begin(), tip);
    Rod rod(spec, {}, 100.0);
    for (int i = 0; i < 300; ++i) substep(rod, 0.1);
    // An arc of 1.5 rad and radius 20 mm that begins 70 mm from the mouth.
    EXPECT_NEAR(rod.tip().y(), 20.0 * (1.0 - std::cos(1.5)), 0.1);
    EXPECT_NEAR(rod.tip().z(), 70.0 + 20.0 * std::sin(1.5), 0.1);
    EXPECT_NEAR(rod.energy_uj(), 0.0, 1e-9);
}

std::uint64_t history_hash(double turn) {
    WireSpec spec = test::amplatz();
    Rod rod(spec, {}, 90.0);
    HashArchive hash;
    for (int i = 0; i < 200; ++i) {
        const std::vector<Vec3> load{Vec3(30.0 * std::cos(0.0), 10.0, -5.0)};
        std::vector<ChainRow> rows(1);
        rows[0].link = 3;
        rows[0].normal = Vec3::UnitX();
        rows[0].gap = 0.01 * (i % 7) - 0.03;
        rows[0].compliance = 0.01;
        rows[0].friction = 0.1;
        substep(rod, 0.004, load, rows, 0.2, turn);
        visit(hash, rod);
    }
    return hash.value();
}

TEST(Rod, TheSameHistoryGivesTheSameBits) {
    EXPECT_EQ(history_hash(0.01), history_hash(0.01));
    EXPECT_NE(history_hash(0.01), history_hash(0.010001));
}

TEST(Rod, AWireInMotionLosesEnergyAndStaysFinite) {
    Rod rod(test::bmw(), {}, 150.0);
    test::settle(rod, 0, Vec3(60.0, 0.0, 0.0), 0.1, 300);
    double energy = rod.energy_uj();
    for (int i = 0; i < 2000; ++i) {
        const Vec3 before = rod.link_pose(0).position;
        substep(rod, 0.004);
        EXPECT_LE(rod.energy_uj(), energy * 1.001 + 1e-6);
        EXPECT_LT((rod.link_pose(0).position - before).norm(), 1.5 * Rod::max_travel_mm());
        energy = rod.energy_uj();
    }
    EXPECT_LT(energy, 1e-3);
}

TEST(Rod, AbsurdCommandsAreClamped) {
    Rod rod(test::bmw(), {}, 60.0);
    const double nan = std::nan(""), inf = std::numeric_limits<double>::infinity();
    EXPECT_EQ(rod.command(nan, inf), 0.0);
    EXPECT_LE(rod.command(1e6, 1e6), Rod::max_travel_mm());
    rod.predict(0.004);
    rod.solve(0.004, {});
    rod.finish(0.004);
    EXPECT_TRUE(std::isfinite(rod.tip().squaredNorm()));
    EXPECT_THROW(rod.predict(0.0), std::logic_error);
    EXPECT_THROW(rod.predict(nan), std::logic_error);
}

TEST(Spec, EveryBadNumberIsNamed) {
    const auto complains_of = [](const char* key, const auto& spoil) {
        WireSpec spec = test::bmw();
        spoil(spec);
        try {
            const Rod rod(spec, {}, 60.0);
        } catch (const UserError& error) {
            return std::string(error.what()).find(key) != std::string::npos;
        }
        return false;
    };
    const double inf = std::numeric_limits<double>::infinity();
    EXPECT_TRUE(complains_of("sections[0].bending_stiffness_n_mm2",
                             [](WireSpec& s) { s.sections[0].bending_stiffness_n_mm2 = 0.0; }));
    EXPECT_TRUE(complains_of("sections[0].torsion_stiffness_n_mm2",
                             [&](WireSpec& s) { s.sections[0].torsion_stiffness_n_mm2 = inf; }));
    EXPECT_TRUE(
        complains_of("sections[0].axial_stiffness_n", [](WireSpec& s) { s.sections[0].axial_stiffness_n = -1.0; }));
    EXPECT_TRUE(complains_of("sections[0].diameter_mm", [](WireSpec& s) { s.sections[0].diameter_mm = std::nan(""); }));
    EXPECT_TRUE(complains_of("sections[0].length_mm", [](WireSpec& s) {
        s.sections.push_back(s.sections[0]);
        s.sections[0].length_mm = 0.0;
    }));
    EXPECT_TRUE(complains_of("link_length_mm", [](WireSpec& s) { s.link_length_mm = 0.0; }));
    EXPECT_TRUE(complains_of("length_mm", [&](WireSpec& s) { s.length_mm = inf; }));
    EXPECT_TRUE(complains_of("sections", [](WireSpec& s) { s.sections.clear(); }));
}

}  // namespace
}  // namespace cathlab
