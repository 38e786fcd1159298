// The wire fed through a tube that bends back by half a turn, as the aorta does, against a wall that gives way.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "core/random.h"
#include "rod_fixture.h"

namespace cathlab {
namespace {

// Axis: up along z, half a circle towards +x, down again.
struct Tube {
    double rise = 200.0, bend = 35.0, radius = 10.0;

    Vec3 nearest_on_axis(const Vec3& p) const {
        if (p.z() < rise) return p.x() < bend ? Vec3(0.0, 0.0, p.z()) : Vec3(2.0 * bend, 0.0, p.z());
        const Vec3 centre(bend, 0.0, rise);
        Vec3 out = p - centre;
        out.y() = 0.0;
        return centre + out.normalized() * bend;
    }
};

struct Outcome {
    double penetration = 0.0, sheath = 0.0, stretch = 0.0, tip_z = 0.0, jump = 0.0;
    bool finite = true;
};

struct Drive {
    double speed = 100.0, turn_rate = 6.28;  // mm/s, rad/s
    double length = 420.0;                   // to be inserted
    int random_substeps = 0;  // if not 0: so many, in and out and round at random, turning back at length
};

Outcome feed(const WireSpec& spec, const Tube& tube, const Drive& drive, double friction) {
    Rod rod(spec, {}, 20.0);
    const double h = 0.004, compliance = 2e-3;
    const int iterations = 2;
    Outcome out;
    std::vector<RodSample> samples;
    double speed = drive.speed, turn_rate = drive.turn_rate;
    for (int step = 0; out.finite; ++step) {
        if (drive.random_substeps > 0 ? step == drive.random_substeps : rod.insertion_mm() > drive.length - 1e-6) break;
        if (drive.random_substeps > 0 && step % 25 == 0) {
            const auto draw = [&](std::uint64_t i) {
                return random_uniform(7, RandomStream::test, static_cast<std::uint64_t>(step), i);
            };
            const bool inward = draw(0) < 0.65 && rod.insertion_mm() < drive.length;
            speed = inward ? drive.speed : -drive.speed;
            turn_rate = (2.0 * draw(1) - 1.0) * drive.turn_rate;
        }
        rod.samples(2.0, samples);
        std::vector<Vec3> before;
        before.reserve(samples.size());
        for (const RodSample& s : samples) before.push_back(s.position);
        const Vec3 tip = rod.tip();
        rod.command(speed * h, turn_rate * h);
        rod.predict(h);
        rod.samples(2.0, samples);
        std::vector<ChainRow> rows(samples.size());
        for (int k = 0; k < iterations; ++k) {
            rod.samples(2.0, samples);
            for (std::size_t i = 0; i < samples.size(); ++i) {
                const Vec3 in = tube.nearest_on_axis(samples[i].position) - samples[i].position;
                ChainRow& row = rows[i];
                row.link = samples[i].link;
                if (k == 0) row.normal = in.norm() > 1e-9 ? Vec3(in.normalized()) : Vec3(Vec3::UnitX());
                row.arm = samples[i].arm - row.normal * samples[i].radius;
                row.compliance = compliance;
                row.gap = tube.radius - samples[i].radius - in.norm() + compliance * row.multiplier;
                row.friction = friction;
                const Vec3 moved = samples[i].position - (i < before.size() ? before[i] : samples[i].position);
                row.slip = moved - row.normal * row.normal.dot(moved) + compliance * row.tangent_force;
            }
            rod.solve(h, rows);
        }
        rod.finish(h);
        rod.samples(2.0, samples);
        for (std::size_t i = 0; i < samples.size(); ++i) {
            const double gap = tube.radius - samples[i].radius -
                               (tube.nearest_on_axis(samples[i].position) - samples[i].position).norm();
            const double wall = i < rows.size() ? compliance * rows[i].multiplier : 0.0;
            out.penetration = std::max(out.penetration, -(gap + wall));
        }
        out.sheath = std::max(out.sheath, std::fabs(rod.sheath_force_mn()));
        out.stretch = std::max(out.stretch, rod.max_stretch());
        out.jump = std::max(out.jump, (rod.tip() - tip).norm());
        out.finite = out.finite && std::isfinite(rod.tip().squaredNorm());
    }
    out.tip_z = rod.tip().z();
    return out;
}

void print(const char* name, const Outcome& o) {
    std::printf("%-28s penetration %.3f mm, sheath %.0f mN, stretch %.5f, tip z %.1f, largest tip step %.2f mm\n", name,
                o.penetration, o.sheath, o.stretch, o.tip_z, o.jump);
}

WireSpec with_floppy_tip(WireSpec spec, double ei) {
    WireSection tip = spec.sections[0];
    tip.length_mm = 20.0;
    tip.bending_stiffness_n_mm2 = ei;
    tip.torsion_stiffness_n_mm2 = ei / 1.3;
    tip.axial_stiffness_n = 1000.0;
    tip.link_length_mm = 2.0;
    spec.sections.insert(spec.sections.begin(), tip);
    tip.bending_stiffness_n_mm2 = std::sqrt(ei * spec.sections[1].bending_stiffness_n_mm2);
    tip.torsion_stiffness_n_mm2 = tip.bending_stiffness_n_mm2 / 1.3;
    spec.sections.insert(spec.sections.begin() + 1, tip);
    return spec;
}

TEST(Tube, AtFullSpeedTheWireStaysInsideAndWhole) {
    const Tube aorta;
    const Outcome thin = feed(with_floppy_tip(test::bmw(4.0), 0.5), aorta, {}, 0.1);
    const Outcome stiff = feed(with_floppy_tip(test::amplatz(4.0), 5.0), aorta, {}, 0.1);
    print("thin wire, aorta", thin);
    print("stiff wire, aorta", stiff);
    for (const Outcome& o : {thin, stiff}) {
        EXPECT_TRUE(o.finite);
        EXPECT_LT(o.penetration, 0.01);
        EXPECT_LT(o.stretch, 1.5e-3);  // of the floppy tip, whose EA is 1000 N
        EXPECT_LT(o.jump, 1.25 * Rod::max_travel_mm());
        EXPECT_LT(o.tip_z, 130.0);
    }
}

TEST(Tube, AThinTipInACoronaryNeverFlutters) {
    // As soft as a coronary wire's tip (0.7 gf), in a tube of 3 mm that turns back within 24 mm, at random full speed.
    const Tube coronary{40.0, 12.0, 1.5};
    const Outcome o = feed(with_floppy_tip(test::bmw(3.0), 0.034), coronary, {100.0, 6.28, 110.0, 1200}, 0.1);
    print("thin wire, coronary", o);
    EXPECT_TRUE(o.finite);
    EXPECT_LT(o.penetration, 0.05);
    EXPECT_LT(o.stretch, 2e-3);
    const Outcome slippery = feed(with_floppy_tip(test::bmw(3.0), 0.034), coronary, {20.0, 6.28, 90.0, 0}, 0.0);
    print("the same without friction", slippery);
    EXPECT_LT(slippery.penetration, 1e-3);
    EXPECT_LT(slippery.jump, 0.3);  // 0.08 mm are fed in a substep
}

TEST(Tube, PushingRoundABendTakesTheEnergyOfTheBend) {
    // Without friction each new millimetre in the bend stores EI / 2 R^2, and that is the force of the hand.  R is that
    // of the outer wall less the wire's radius, once the wire lies along it.
    const Tube aorta;
    const double bend = aorta.bend + aorta.radius - 0.4445;
    const double expected = 0.5 * 1850e3 / (bend * bend);
    const Outcome o = feed(test::amplatz(4.0), aorta, {30.0, 0.0, 330.0, 0}, 0.0);
    EXPECT_GT(o.sheath, expected);  // the wire starts and ends the bend more sharply than the wall
    EXPECT_LT(o.sheath, 2.0 * expected);
}

}  // namespace
}  // namespace cathlab
