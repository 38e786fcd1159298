// The wire fed through a tube that bends back by half a turn, as the aorta does, against a wall that gives way.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>

#include "core/units.h"
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
    double penetration = 0.0, sheath = 0.0, stretch = 0.0, tip_z = 0.0, jump = 0.0, solve_ms = 0.0;
    bool finite = true;
};

Outcome feed(const WireSpec& spec, const Tube& tube, double length, double speed, double turn_rate, double friction,
             int iterations) {
    Rod rod(spec, {}, 20.0);
    const double h = 0.004, compliance = 2e-3;
    Outcome out;
    std::vector<RodSample> samples;
    double time = 0.0, solves = 0.0;
    while (rod.insertion_mm() < length - 1e-6) {
        rod.samples(2.0, samples);
        std::vector<Vec3> before;
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
            const auto begin = std::chrono::steady_clock::now();
            rod.solve(h, rows);
            const auto end = std::chrono::steady_clock::now();
            time += std::chrono::duration<double, std::milli>(end - begin).count();
            solves += 1.0;
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
        if (!out.finite) break;
    }
    out.tip_z = rod.tip().z();
    out.solve_ms = time / solves;
    return out;
}

void print(const char* name, const Outcome& o) {
    std::printf(
        "%-28s penetration %.3f mm, sheath %.0f mN, stretch %.5f, tip z %.1f, largest tip step %.2f mm, %.3f ms\n",
        name, o.penetration, o.sheath, o.stretch, o.tip_z, o.jump, o.solve_ms);
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

TEST(Tube, AWireGoesRoundTheBendAndDownAgain) {
    const Tube aorta;
    for (const double friction : {0.0, 0.1}) {
        for (const double speed : {30.0, 100.0}) {
            for (const double turn : {0.0, 6.28}) {
                char name[80];
                std::snprintf(name, sizeof name, "thin mu %.1f v %.0f w %.1f", friction, speed, turn);
                Outcome o = feed(with_floppy_tip(test::bmw(4.0), 0.5), aorta, 450.0, speed, turn, friction, 2);
                print(name, o);
                std::snprintf(name, sizeof name, "stiff mu %.1f v %.0f w %.1f", friction, speed, turn);
                o = feed(with_floppy_tip(test::amplatz(4.0), 5.0), aorta, 450.0, speed, turn, friction, 2);
                print(name, o);
            }
        }
    }
}

}  // namespace
}  // namespace cathlab
