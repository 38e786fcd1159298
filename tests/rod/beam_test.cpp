// The chain against the closed forms of the straight beam.
#include <gtest/gtest.h>

#include <cmath>

#include "plot_file.h"
#include "rod_fixture.h"

namespace cathlab {
namespace {

using test::settle;

double drop_error(const WireSpec& spec, double insertion, double relative_drop) {
    Rod rod(spec, {}, insertion);
    const double arm = insertion - 0.5 * rod.link_length(0);  // the force acts on the first link's centre
    const double ei = spec.sections[0].bending_stiffness_n_mm2 * 1000.0;
    const double force = relative_drop * arm * 3.0 * ei / (arm * arm * arm);
    const Vec3 before = rod.link_pose(0).position;
    settle(rod, 0, Vec3(force, 0.0, 0.0));
    const double drop = rod.link_pose(0).position.x() - before.x();
    return drop / (relative_drop * arm) - 1.0;
}

TEST(Beam, ACantileverDropsAsTheBeamEquationSays) {
    for (const double insertion : {60.0, 151.0, 300.7}) {
        EXPECT_NEAR(drop_error(test::bmw(), insertion, 0.01), 0.0, 0.01) << "thin wire, " << insertion << " mm";
        EXPECT_NEAR(drop_error(test::amplatz(), insertion, 0.01), 0.0, 0.01) << "stiff wire, " << insertion << " mm";
    }
}

TEST(Beam, HalvingTheLinksQuartersTheError) {
    const double coarse = std::fabs(drop_error(test::amplatz(12.0), 144.0, 0.001));
    const double fine = std::fabs(drop_error(test::amplatz(6.0), 144.0, 0.001));
    const double finest = std::fabs(drop_error(test::amplatz(3.0), 144.0, 0.001));
    EXPECT_LT(fine, 0.35 * coarse);
    EXPECT_LT(finest, 0.35 * fine);
    RecordProperty("coarse", std::to_string(coarse));
    std::printf("errors %g %g %g\n", coarse, fine, finest);
}

TEST(Beam, TheWireStretchesByItsAxialStiffness) {
    const WireSpec spec = test::bmw();
    Rod rod(spec, {}, 300.0);
    const double before = rod.link_pose(0).position.z();
    const double force = 5000.0;
    settle(rod, 0, Vec3(0.0, 0.0, force));
    const double expected = force * (300.0 - 0.5 * rod.link_length(0)) / (spec.sections[0].axial_stiffness_n * 1000.0);
    EXPECT_NEAR(rod.link_pose(0).position.z() - before, expected, 0.01 * expected);
    EXPECT_LT(rod.max_stretch(), 1e-3);
    EXPECT_NEAR(rod.sheath_force_mn(), -force, 1e-6 * force);
}

// Tip of the elastica: a cantilever of length 1, EI = 1 under a dead load `p` across, by Runge-Kutta from the clamp
// with the clamp's moment found by bisection so that the tip's is zero.  Angle a from the axis: a'' = -p cos a.
Vec2 elastica_tip(double p) {
    const int n = 1000;
    const double ds = 1.0 / n;
    Vec2 tip = Vec2::Zero();
    double low = 0.0, high = p;
    for (int pass = 0; pass < 60; ++pass) {
        double a = 0.0, m = 0.5 * (low + high);
        tip.setZero();
        for (int i = 0; i < n; ++i) {
            const double a_mid = a + 0.5 * ds * m, m_mid = m - 0.5 * ds * p * std::cos(a);
            tip += ds * Vec2(std::cos(a_mid), std::sin(a_mid));
            m -= ds * p * std::cos(a_mid);
            a += ds * m_mid;
        }
        (m > 0.0 ? high : low) = 0.5 * (low + high);
    }
    return tip;
}

TEST(Beam, ALargeBendFollowsTheElastica) {
    const WireSpec spec = test::bmw();
    Plot plot = test::theory_and_points("A cantilever under a dead load: drop of the tip", "P L2 / EI", "drop / L", 0.0,
                                        4.0, [](double p) { return elastica_tip(p).y(); });
    for (const double p : {0.5, 1.0, 2.0, 3.5}) {
        Rod rod(spec, {}, 150.0);
        const double arm = 150.0 - 0.5 * rod.link_length(0);
        settle(rod, 0, Vec3(0.0, p * 75e3 / (arm * arm), 0.0), 0.2, 250);
        const Vec2 expected = arm * elastica_tip(p);
        const Vec3 found = rod.link_pose(0).position;
        EXPECT_NEAR(found.y(), expected.y(), 0.01 * expected.y()) << "p = " << p;
        EXPECT_NEAR(arm - found.z(), arm - expected.x(), 0.02 * (arm - expected.x())) << "p = " << p;
        test::add_point(plot, p, found.y() / arm);
    }
    test::keep(plot, "cantilever");
}

TEST(Beam, ItBucklesAtEulersLoad) {
    // A column clamped at the mouth, free at the tip: P = pi^2 EI / (2 L)^2.  A tiny side load grows by 1 / (1 - F /
    // P).
    const WireSpec spec = test::amplatz();
    const double insertion = 120.0, ei = 1850e3;
    const auto sway = [&](double share) {
        Rod rod(spec, {}, insertion);
        const double arm = insertion - 0.5 * rod.link_length(0);
        const double load = share * 9.8696 * ei / (4.0 * arm * arm);
        settle(rod, 0, Vec3(0.1, 0.0, -load), 1.0, 600);
        return rod.link_pose(0).position.x();
    };
    // For a side load at the tip the growth is 3 (tan u - u) / u^3 with u = pi/2 sqrt(F / P).
    const double straight = sway(0.0);
    const auto growth = [](double share) {
        const double u = 1.5707963 * std::sqrt(share);
        return share == 0.0 ? 1.0 : 3.0 * (std::tan(u) - u) / (u * u * u);
    };
    Plot plot = test::theory_and_points("A column below Euler's load: growth of a side load's drop",
                                        "load / Euler's load", "drop / drop without load", 0.0, 0.92, growth);
    for (const double share : {0.3, 0.5, 0.8, 0.9}) {
        const double found = sway(share) / straight;
        EXPECT_NEAR(found, growth(share), 0.03 / (1.0 - share)) << share;
        test::add_point(plot, share, found);
    }
    test::keep(plot, "buckling");
    EXPECT_GT(std::fabs(sway(1.03)), 100.0 * straight);
    EXPECT_LT(std::fabs(sway(0.97)), 60.0 * straight);
}

}  // namespace
}  // namespace cathlab
