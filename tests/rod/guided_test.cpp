// A wire that is led: over a rigid bend, in a tube that holds it, round a curve with a tip of its own shape.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "core/units.h"
#include "plot_file.h"
#include "rigid_guide.h"

namespace cathlab {
namespace {

using test::GuidedWire;
using test::Touch;

TEST(Capstan, TheTensionGrowsByTheExponentialOfFrictionTimesAngle) {
    // Pulled back over a rigid cylinder against a dead load T at its tip: T e^(mu angle) at the sheath.  A wire of
    // bending stiffness EI on a radius R has (T2 - EI / 2 R^2) = (T1 - EI / 2 R^2) e^(mu angle): here EI / 2 R^2 is
    // nothing.
    WireSpec spec = test::uniform_wire(0.01, 0.2, 1.0, 400.0);
    spec.sections[0].axial_stiffness_n = 5000.0;
    const double radius = 20.0, start = 20.0, load = 100.0;
    Plot plot = test::theory_and_points("A wire drawn over half a cylinder: tension behind over tension before",
                                        "coefficient of friction", "ratio", 0.0, 0.4,
                                        [](double mu) { return std::exp(mu * units::pi); });
    for (const double angle : {0.5 * units::pi, units::pi})
        for (const double friction : angle > 2.0 ? std::vector{0.0, 0.1, 0.2, 0.4} : std::vector{0.3}) {
            // From the mouth straight up, round a cylinder about y at (-radius - r, ., start) by `angle`, straight on.
            const double r = radius + 0.1;
            std::vector<Vec3> path;
            for (int i = 0; i <= 200; ++i) {
                const double a = angle * i / 200.0;
                path.push_back(Vec3(-r + r * std::cos(a), 0.0, start + r * std::sin(a)));
            }
            const Vec3 on(-std::sin(angle), 0.0, std::cos(angle));
            path.push_back(path.back() + 60.0 * on);
            GuidedWire wire(Rod(spec, {}, start + r * angle + 50.0, path));
            wire.friction = friction;
            wire.walls = [&](const RodSample& sample, std::vector<Touch>& out) {
                Vec3 away = sample.position - Vec3(-r, 0.0, start);
                away.y() = 0.0;
                const double distance = away.norm();
                if (distance < r + 2.0) out.push_back({away / distance, distance - r});
            };
            const std::vector<Vec3> pull{load * on};
            const double h = 0.01;
            for (int i = 0; i < 200; ++i) wire.step(h, 0.0, 0.0, pull);
            double mean = 0.0;
            for (int i = 0; i < 200; ++i) {
                wire.step(h, -0.05, 0.0, pull);
                if (i >= 100) mean -= wire.rod.sheath_force_mn() / 100.0;
            }
            const double expected = load * std::exp(friction * angle);
            std::printf("capstan: %.0f deg, mu %.1f: %.2f mN of %.2f, %+.2f %%\n", angle / units::deg, friction, mean,
                        expected, 100.0 * (mean / expected - 1.0));
            EXPECT_NEAR(mean, expected, 0.05 * expected);
            if (angle > 2.0) test::add_point(plot, friction, mean / load);
        }
    test::keep(plot, "capstan");
}

TEST(Helix, APressedWireInATubeCoilsAndPressesAsLubinskiSays) {
    // Weightless, without friction and torque: pitch^2 = 8 pi^2 EI / F, and F^2 r / (4 EI) of contact force a length
    // [lubinski1962], r = the room between wire and tube.
    const double ei = 75e3, room = 1.0, insertion = 420.0, force = 1000.0;
    const double pitch = std::sqrt(8.0 * units::pi * units::pi * ei / force);
    std::vector<Vec3> path;
    for (int i = 1; i <= 1000; ++i) {
        const double z = i * 0.5, a = 2.0 * units::pi * z / (0.9 * pitch), r = room * std::min(1.0, z / 40.0);
        path.push_back(Vec3(r * std::cos(a), r * std::sin(a), z));
    }
    GuidedWire wire(Rod(test::bmw(3.0), {}, insertion, path));
    wire.compliance = 1e-6;
    wire.walls = [&](const RodSample& sample, std::vector<Touch>& out) {
        const Vec3 off(sample.position.x(), sample.position.y(), 0.0);
        if (off.norm() > 0.5 * room) out.push_back({-off / off.norm(), room - off.norm()});
    };
    const std::vector<Vec3> push{Vec3(0.0, 0.0, -force)};
    for (int i = 0; i < 2000; ++i) wire.step(0.05, 0.0, 0.0, push);
    double press = 0.0, turned = 0.0, along = 0.0;
    Vec3 last = Vec3::Zero();
    Plot plot = test::theory_and_points("A wire pressed in a tube: contact force along it", "place, mm", "force, mN/mm",
                                        0.0, insertion, [&](double) { return force * force * room / (4.0 * ei); });
    for (std::size_t i = 0; i < wire.rows.size(); ++i) {
        const Vec3 p = wire.rod.link_pose(static_cast<std::size_t>(wire.rows[i].link)).position;
        test::add_point(plot, p.z(), wire.rows[i].multiplier / 3.0);
        if (p.z() < 0.33 * insertion || p.z() > 0.67 * insertion) continue;
        press += wire.rows[i].multiplier;
        if (last.z() > 0.0) {
            turned += std::fabs(std::atan2(p.x() * last.y() - p.y() * last.x(), p.x() * last.x() + p.y() * last.y()));
            along += last.z() - p.z();
        }
        last = p;
    }
    test::keep(plot, "helix");
    const double length = along + 3.0, found_pitch = 2.0 * units::pi * along / turned;
    const double expected = force * force * room / (4.0 * ei);
    std::printf("helix: pitch %.2f mm of %.2f, %.3f mN/mm of %.3f\n", found_pitch, pitch, press / length, expected);
    EXPECT_NEAR(found_pitch, pitch, 0.03 * pitch);
    EXPECT_NEAR(press / length, expected, 0.03 * expected);
}

TEST(Torque, FrictionWindsTheWireUpBeforeTheTipTurns) {
    // Held between two walls that press on it by p a length each: friction takes q = 2 mu p r a length of torque, and
    // when the tip turns the sheath is ahead of it by q L^2 / (2 GJ).
    const WireSpec spec = test::bmw(2.5);
    const double length = 300.0, mu = 0.3, load = 5.0;  // mN a link and wall
    const double gj = 1000.0 * spec.sections[0].torsion_stiffness_n_mm2, radius = 0.5 * spec.sections[0].diameter_mm;
    GuidedWire wire(Rod(spec, {}, length + 1.25));
    wire.friction = mu;
    wire.compliance = 1e-7;
    wire.walls = [&](const RodSample& sample, std::vector<Touch>& out) {
        for (const double side : {1.0, -1.0})
            out.push_back({side * Vec3::UnitY(), side * sample.position.y() - load * wire.compliance});
    };
    const auto tip_angle = [&] {
        const Vec3 x = wire.rod.link_pose(0).orientation * Vec3::UnitX();
        return std::atan2(x.y(), x.x());
    };
    const double q = 2.0 * mu * load * radius / 2.5, expected = q * length * length / (2.0 * gj);
    Plot plot =
        test::theory_and_points("A wire turned against friction: its grip ahead of its tip", "turn of the grip, rad",
                                "ahead, rad", 0.0, 6.0, [&](double a) { return std::min(a, expected); });
    double turned = 0.0, before = tip_angle();
    for (int i = 0; i < 400; ++i) {
        wire.step(0.005, 0.0, 2.0 * units::pi * 0.005);  // 360 deg/s
        const double now = tip_angle();
        turned += std::remainder(now - before, 2.0 * units::pi);
        before = now;
        if (i % 4 == 0 && wire.rod.rotation_rad() < 6.0)
            test::add_point(plot, wire.rod.rotation_rad(), wire.rod.rotation_rad() - turned);
    }
    test::keep(plot, "wind-up");
    const double ahead = wire.rod.rotation_rad() - turned;
    std::printf("wind-up: %.4f rad of %.4f; torque %.1f of %.1f mN mm\n", ahead, expected,
                wire.rod.sheath_torque_mn_mm(), q * length);
    EXPECT_NEAR(ahead, expected, 0.03 * expected);
    EXPECT_NEAR(wire.rod.sheath_torque_mn_mm(), q * length, 0.03 * q * length);
}

TEST(Torque, ATurnThatFrictionHoldsIsStillThereAfterARest) {
    // Turned by less than it takes to move the tip: the twist reaches as far as the torque lasts, and stays.
    const WireSpec spec = test::bmw(2.5);
    GuidedWire wire(Rod(spec, {}, 301.25));
    wire.friction = 0.3;
    wire.compliance = 1e-7;
    wire.walls = [&](const RodSample& sample, std::vector<Touch>& out) {
        for (const double side : {1.0, -1.0})
            out.push_back({side * Vec3::UnitY(), side * sample.position.y() - 5.0 * wire.compliance});
    };
    for (int i = 0; i < 100; ++i) wire.step(0.005, 0.0, 0.001);
    const double torque = wire.rod.sheath_torque_mn_mm();
    EXPECT_GT(torque, 20.0);
    for (int i = 0; i < 2000; ++i) wire.step(0.005);
    std::printf("torque %.3f mN mm, after 10 s at rest %.3f\n", torque, wire.rod.sheath_torque_mn_mm());
    EXPECT_NEAR(wire.rod.sheath_torque_mn_mm(), torque, 0.01 * torque);
}

TEST(Slope, AWireOnASlopeBelowTheAngleOfFrictionStays) {
    // It lies along a slope of rise over run; what pulls it down across its axis is that part of its weight.
    const double mu = 0.3, weight = 2.0;  // mN a link
    for (const double slope : {0.15, 0.27, 0.33}) {
        GuidedWire wire(Rod(test::uniform_wire(1.0, 0.356, 2.5), {}, 200.0));
        wire.friction = mu;
        wire.walls = [&](const RodSample& sample, std::vector<Touch>& out) {
            out.push_back({Vec3::UnitY(), sample.position.y(), sample.radius * Vec3::UnitY()});  // it cannot roll
        };
        const double length = std::sqrt(1.0 + slope * slope);
        const std::vector<Vec3> down(wire.rod.free_link_count(), weight / length * Vec3(slope, -1.0, 0.0));
        const std::vector<Vec3> level(down.size(), weight / length * Vec3(0.0, -1.0, 0.0));
        for (int i = 0; i < 100; ++i) wire.step(0.004, 0.0, 0.0, level);
        const double start = wire.rod.tip().x();
        for (int i = 0; i < 2500; ++i) wire.step(0.004, 0.0, 0.0, down);
        const double slid = wire.rod.tip().x() - start;
        std::printf("slope %.2f, friction %.2f: slid %.5f mm in 10 s\n", slope, mu, slid);
        if (slope < mu) {
            EXPECT_LT(slid, 0.003);  // the bristle's own length, 0.5 mm/s in a substep
        } else {
            EXPECT_GT(slid, 1.0);
        }
    }
}

/// Angle at the tip of a wire with rest curvature k0 held to a curve k: GJ a'' = EI k0 k sin a, a(0) = sheath, a'(L) =
/// 0.
double whipped_tip(double sheath, double length, double ei_k0_k_over_gj) {
    const auto at_sheath = [&](double tip) {
        const int n = 500;
        const double ds = length / n;
        double a = tip, slope = 0.0;
        for (int i = 0; i < n; ++i) {
            const double middle = a + 0.5 * ds * slope;
            slope += ds * ei_k0_k_over_gj * std::sin(middle);
            a = middle + 0.5 * ds * slope;
        }
        return a;
    };
    double low = 0.0, high = sheath;
    for (int i = 0; i < 60; ++i) (at_sheath(0.5 * (low + high)) < sheath ? low : high) = 0.5 * (low + high);
    return 0.5 * (low + high);
}

TEST(Torque, AShapedWireInABendLagsAsThePendulumEquationSays) {
    // A wire with a rest curvature in a curved groove prefers one angle; turned away from it, it winds up.  A straight
    // wire in the same groove follows the sheath one to one.
    const double bend = 60.0, length = 120.0;
    Plot plot = test::theory_and_points("A wire with a rest curvature in a bend: its tip", "turn of the grip, rad",
                                        "turn of the tip, rad", 0.0, 2.0,
                                        [&](double a) { return whipped_tip(a, length, 1.3 * 0.004 / bend); });
    for (const double rest : {0.0, 0.004}) {
        WireSpec spec = test::uniform_wire(75.0, 0.356, 2.0);
        spec.sections[0].rest_curvature_per_mm = rest;
        // The groove turns from z towards -y, as the rest curvature does at angle 0.
        std::vector<Vec3> path;
        for (int i = 1; i <= 600; ++i) {
            const double a = 0.25 * i / bend;
            path.push_back(Vec3(0.0, bend * (1.0 - std::cos(a)), bend * std::sin(a)));
        }
        GuidedWire wire(Rod(spec, {}, length, path));
        wire.compliance = 1e-7;
        wire.walls = [&](const RodSample& sample, std::vector<Touch>& out) {
            Vec3 from = sample.position - Vec3(0.0, bend, 0.0);
            from.x() = 0.0;
            const double radius = from.norm();
            out.push_back({Vec3::UnitX(), sample.position.x(), Vec3::Zero(), true});
            out.push_back({from / radius, radius - bend, Vec3::Zero(), true});
        };
        for (int i = 0; i < 100; ++i) wire.step(0.1);
        const double ratio =
            spec.sections[0].bending_stiffness_n_mm2 * rest / bend / spec.sections[0].torsion_stiffness_n_mm2;
        const auto tip_angle = [&] {  // about its own tangent, from the x axis, which is square to the groove's plane
            const Mat3 f = wire.rod.link_pose(0).orientation.toRotationMatrix();
            return std::atan2(-f.col(1).x(), f.col(0).x());
        };
        for (const double target : {0.5, 1.0, 1.5, 2.0}) {
            const double from = wire.rod.rotation_rad();
            for (int i = 0; i < 100; ++i) wire.step(0.05, 0.0, (target - from) / 100.0);
            for (int i = 0; i < 200; ++i) wire.step(0.1);
            const double expected = whipped_tip(target, length, ratio);
            std::printf("shaped in a bend, rest %.3f: sheath %.2f rad, tip %.4f of %.4f\n", rest, target, tip_angle(),
                        expected);
            EXPECT_NEAR(tip_angle(), expected, 0.03 * target);
            if (rest > 0.0) test::add_point(plot, target, tip_angle());
        }
    }
    test::keep(plot, "shaped-in-a-bend");
}

}  // namespace
}  // namespace cathlab
