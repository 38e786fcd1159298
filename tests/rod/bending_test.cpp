// Bends beyond the cantilever: the closed ring, three supports, a column between walls, a bar that rings.
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

double total_turn(const Rod& rod, std::size_t from) {
    double sum = 0.0;
    for (std::size_t i = from; i + 1 < rod.link_count(); ++i) {
        const Vec3 a = rod.link_pose(i).orientation * Vec3::UnitZ(),
                   b = rod.link_pose(i + 1).orientation * Vec3::UnitZ();
        sum += std::atan2(a.cross(b).norm(), a.dot(b));
    }
    return sum;
}

TEST(Bending, AMomentOfTwoPiEIOverLengthClosesTheRing) {
    for (const WireSpec& spec : {test::bmw(3.0), test::amplatz(3.0)}) {
        Rod rod(spec, {}, 201.0);
        const double length = 201.0 - 1.5 * rod.link_length(0);  // from the clamp to the centre of link 1
        const double moment = 2.0 * units::pi * 1000.0 * spec.sections[0].bending_stiffness_n_mm2 / length;
        // A couple of forces on the centres of links 0 and 1, across them wherever they turn.
        const int ramp = 1500;
        for (int i = 0; i < ramp + 500; ++i) {
            const Vec3 along = rod.link_pose(0).position - rod.link_pose(1).position;
            const Vec3 across = Vec3::UnitY().cross(along).normalized();
            const double force = moment / along.norm() * std::min(1.0, static_cast<double>(i) / ramp);
            const std::vector<Vec3> couple{force * across, -force * across};
            test::substep(rod, 0.1, couple);
        }
        const double turn = total_turn(rod, 1);
        std::printf("ring: turned by %.4f of a full turn, open by %.3f mm\n", turn / (2.0 * units::pi),
                    rod.link_pose(1).position.norm());
        EXPECT_NEAR(turn, 2.0 * units::pi, 0.03 * 2.0 * units::pi);
        EXPECT_LT(rod.link_pose(1).position.norm(), 0.03 * length);
    }
}

TEST(Bending, SupportsOfAPressedWireReadTheBeamsReactions) {
    // Clamped at 0, on supports at a and a + s, pressed by F half way between these: three moments at the supports.
    const double a = 90.0, s = 120.0;
    for (const WireSpec& spec : {test::bmw(2.0), test::amplatz(2.0)}) {
        const double force = 0.02 * spec.sections[0].bending_stiffness_n_mm2;  // bends it by 0.4 mm
        GuidedWire wire(Rod(spec, {}, 231.0));
        const auto z_of = [&](std::size_t i) { return wire.rod.link_pose(i).position.z(); };
        const auto nearest = [&](double z) {
            std::size_t best = 0;
            for (std::size_t i = 1; i < wire.rod.free_link_count(); ++i)
                if (std::fabs(z_of(i) - z) < std::fabs(z_of(best) - z)) best = i;
            return best;
        };
        const std::size_t first = nearest(a), second = nearest(a + s), pressed = nearest(a + 0.5 * s);
        const double za = z_of(first), zb = z_of(second), zf = z_of(pressed), span = zb - za;
        wire.compliance = 1e-7;
        wire.walls = [&](const RodSample& sample, std::vector<Touch>& out) {
            const auto link = static_cast<std::size_t>(sample.link);
            if (link == first || link == second) out.push_back({Vec3::UnitX(), sample.position.x()});
        };
        std::vector<Vec3> load(pressed + 1, Vec3::Zero());
        load[pressed] = Vec3(-force, 0.0, 0.0);
        for (int i = 0; i < 300; ++i) wire.step(0.5, 0.0, 0.0, load);
        // a m0 / 3 + a m1 / 6 = 0;  a m0 / 6 + (a + s) m1 / 3 = -F b c (s + c) / (6 s), b and c the load's two arms
        const double b = zf - za, c = zb - zf;
        const double m1 = -force * b * c * (span + c) / (6.0 * span) / ((za + span) / 3.0 - za / 12.0), m0 = -0.5 * m1;
        const double right = (force * b + m1) / span;
        const double left = force - right + (m0 - m1) / za;
        std::printf("supports: %.3f of %.3f mN, %.3f of %.3f mN, sheath %.3f\n", wire.rows[1].multiplier, left,
                    wire.rows[0].multiplier, right, wire.rod.sheath_reaction_mn().x());
        ASSERT_EQ(wire.rows.size(), 2U);  // tip first
        EXPECT_NEAR(wire.rows[0].multiplier, right, 0.01 * right);
        EXPECT_NEAR(wire.rows[1].multiplier, left, 0.01 * left);
        const double sum = wire.rows[0].multiplier + wire.rows[1].multiplier + wire.rod.sheath_reaction_mn().x();
        EXPECT_NEAR(sum, force, 0.001 * force);
    }
}

TEST(Bending, AColumnBetweenWallsPressesOnThemAsTheBeamColumnDoes) {
    // Clamped at both ends, L long, with room for h to the side.  From 4 pi^2 EI / L^2 on it leans on a wall in the
    // middle, up to 16 pi^2 EI / L^2 at one point, with the force R = 2 P h / (l - 2/k tan(k l / 2)), l = L / 2, k^2 =
    // P / EI.
    const double length = 150.0, room = 1.0;
    const WireSpec spec = test::amplatz(1.5);
    const double ei = 1850e3;
    const auto load_of = [&](double share) { return share * 4.0 * units::pi * units::pi * ei / (length * length); };
    const auto press_of = [&](double share) {
        const double l = 0.5 * length, k = std::sqrt(load_of(share) / ei);
        return 2.0 * load_of(share) * room / (l - 2.0 / k * std::tan(0.5 * k * l));
    };
    Plot plot = test::theory_and_points("A column between walls: force on the wall", "load / (4 pi2 EI / L2)",
                                        "force, mN", 1.001, 4.0, press_of);
    for (const double share : {1.5, 2.25, 3.5}) {  // of 4 pi^2 EI / L^2
        GuidedWire wire(Rod(spec, {}, length + 0.75));
        wire.compliance = 1e-7;
        const double load = load_of(share);
        wire.walls = [&](const RodSample& sample, std::vector<Touch>& out) {
            out.push_back({-Vec3::UnitX(), room - sample.position.x()});
            out.push_back({Vec3::UnitX(), room + sample.position.x()});
            out.push_back({Vec3::UnitY(), sample.position.y(), Vec3::Zero(), true});  // it stays in its plane
            if (sample.link != 0) return;
            const Pose front = wire.rod.link_pose(0);  // and its front link on its axis
            for (const double end : {0.5, -0.5}) {
                const Vec3 offset = front.orientation * Vec3(0.0, 0.0, end * wire.rod.link_length(0));
                out.push_back({Vec3::UnitX(), front.position.x() + offset.x(), offset, true});
            }
        };
        std::vector<Vec3> force(60, Vec3::Zero());
        double press = 0.0;
        for (int i = 0; i < 600; ++i) {
            force[0] = Vec3(0.0, 0.0, -load * std::min(1.0, (i + 1) / 100.0));
            force[50] = Vec3(i < 150 ? 5.0 : 0.0, 0.0, 0.0);
            wire.step(0.1, 0.0, 0.0, force);
        }
        for (std::size_t r = 0; r < wire.rows.size(); ++r)
            if (std::fabs(wire.rows[r].normal.x()) > 0.5 && wire.at[r].link > 3) press += wire.rows[r].multiplier;
        const double expected = press_of(share);
        test::add_point(plot, share, press);
        std::printf("between walls, P = %.2f x 4 pi^2 EI / L^2: %.3f mN of %.3f\n", share, press, expected);
        EXPECT_NEAR(press, expected, 0.03 * expected);
    }
    test::keep(plot, "between-walls");
}

TEST(Bending, ACantileverRingsAtItsNaturalFrequency) {
    // omega = 1.8751^2 sqrt(EI / (m' L^4)); the link at the tip is a whole link of mass, as the beam's end is.
    for (WireSpec spec : {test::bmw(2.0), test::amplatz(2.0)}) {
        spec.damping_per_s = spec.spin_damping_per_s = 0.0;
        const double length = 150.0, ei = 1000.0 * spec.sections[0].bending_stiffness_n_mm2;
        Rod rod(spec, {}, length);
        const double mass = rod.link_mass(0) / rod.link_length(0);
        const double omega = 1.875104 * 1.875104 * std::sqrt(ei / (mass * std::pow(length, 4)));
        const double period = 2.0 * units::pi / omega, h = period / 1000.0;
        test::settle(rod, 0, Vec3(0.005 * 3.0 * ei / (length * length), 0.0, 0.0), 0.5, 100);
        std::vector<double> crossings;
        double before = rod.tip().x();
        const double first = before;
        Plot plot = test::theory_and_points("A cantilever let go: its tip", "time, s", "tip / first tip", 0.0,
                                            3.0 * period, [&](double t) { return std::cos(omega * t); });
        for (int i = 1; i < 3 * 1000; ++i) {
            test::substep(rod, h);
            const double now = rod.tip().x();
            if (before > 0.0 && now <= 0.0) crossings.push_back(h * (i - 1 + before / (before - now)));
            before = now;
            if (i % 50 == 0) test::add_point(plot, h * i, now / first);
        }
        test::keep(plot, "frequency");
        ASSERT_GE(crossings.size(), 3U);
        const double found = 0.5 * (crossings[2] - crossings[0]);
        std::printf("frequency: %.3f Hz of %.3f\n", 1.0 / found, 1.0 / period);
        EXPECT_NEAR(found, period, 0.01 * period);
    }
}

}  // namespace
}  // namespace cathlab
