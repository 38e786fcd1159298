// Wires and catheters that nobody would build: refused with a sentence, or simulated without a fault.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <limits>

#include "core/errors.h"
#include "core/random.h"
#include "rod_fixture.h"

namespace cathlab {
namespace {

double draw(std::uint64_t seed, std::uint64_t i) {
    return random_uniform(seed, RandomStream::test, 0, i);
}
double draw_log(std::uint64_t seed, std::uint64_t i, double low, double high) {
    return low * std::pow(high / low, draw(seed, i));
}

/// Anything that validate() lets through: stiffnesses over nine decades side by side, hairs and rods, curls.
WireSpec wild_wire(std::uint64_t seed) {
    WireSpec spec;
    spec.name = "wild";
    spec.length_mm = draw_log(seed, 1, 100.0, 1000.0);
    spec.link_length_mm = draw_log(seed, 2, 1.0, 0.2 * spec.length_mm);
    spec.friction = draw(seed, 3) * 2.0;
    spec.damping_per_s = draw_log(seed, 4, 0.1, 1e5);
    spec.spin_damping_per_s = draw_log(seed, 5, 0.1, 1e5);
    const int sections = 1 + static_cast<int>(4.0 * draw(seed, 6));
    for (int k = 0; k < sections; ++k) {
        const std::uint64_t n = 10 + 20 * static_cast<std::uint64_t>(k);
        WireSection s;
        s.length_mm = draw_log(seed, n, 0.2, 0.2 * spec.length_mm);
        s.diameter_mm = draw_log(seed, n + 1, 0.05, 10.0);
        s.bending_stiffness_n_mm2 = draw_log(seed, n + 2, 1e-3, 1e6);
        s.torsion_stiffness_n_mm2 = draw_log(seed, n + 3, 1e-3, 1e6);
        s.axial_stiffness_n = draw_log(seed, n + 4, 1.0, 1e7);
        s.density_kg_m3 = draw_log(seed, n + 5, 100.0, 25000.0);
        s.rest_curvature_per_mm = draw(seed, n + 6) < 0.5 ? 0.0 : 2.0 * draw(seed, n + 7) - 1.0;
        s.link_length_mm = draw(seed, n + 8) < 0.5 ? 0.0 : draw_log(seed, n + 9, 0.5, 50.0);
        s.material = "polymer";
        spec.sections.push_back(s);
    }
    return spec;
}

void operate(Rod& rod, std::uint64_t seed, int steps) {
    for (int i = 0; i < steps; ++i) {
        const auto at = [&](std::uint64_t k) { return draw(seed, 1000 + 8 * static_cast<std::uint64_t>(i / 20) + k); };
        const Vec3 pull = (Vec3(at(0), at(1), at(2)) - Vec3::Constant(0.5)) * (at(3) < 0.2 ? 2000.0 : 20.0);
        rod.command_sleeve(2.0 * at(4) - 1.0, at(5) - 0.5);
        test::substep(rod, 0.005, std::vector{pull}, {}, 2.0 * at(6) - 0.8, at(7) - 0.5);
        ASSERT_TRUE(std::isfinite(rod.tip().squaredNorm())) << "seed " << seed << " step " << i;
        ASSERT_TRUE(std::isfinite(rod.energy_uj())) << "seed " << seed << " step " << i;
        ASSERT_LT(rod.tip().norm(), 20.0 * rod.spec().length_mm) << "seed " << seed << " step " << i;
    }
}

TEST(Hostile, AnyWireThatIsNotRefusedCanBeOperated) {
    int refused = 0;
    for (std::uint64_t seed = 1; seed <= 16; ++seed) {
        try {
            Rod rod(wild_wire(seed), {}, 1e3 * draw(seed, 7));
            operate(rod, seed, 100);
        } catch (const UserError&) {
            ++refused;
        }
        if (HasFatalFailure()) return;
    }
    std::printf("refused %d of 16\n", refused);
    EXPECT_LT(refused, 8);
}

TEST(Hostile, AnyCatheterOverAnyWireThatIsNotRefusedCanBeOperated) {
    int refused = 0;
    for (std::uint64_t seed = 101; seed <= 116; ++seed) {
        const WireSpec tube = wild_wire(seed + 1000);
        WireSpec wire = wild_wire(seed);
        SleeveSpec sleeve;
        sleeve.name = "wild";
        sleeve.length_mm = tube.length_mm;
        sleeve.link_length_mm = tube.link_length_mm;
        sleeve.sections = tube.sections;
        sleeve.wire_friction = 2.0 * draw(seed, 8);
        double narrowest = 10.0;
        for (const WireSection& s : sleeve.sections) narrowest = std::min(narrowest, s.diameter_mm);
        sleeve.inner_diameter_mm = 0.9 * narrowest;
        for (WireSection& s : wire.sections) s.diameter_mm = std::min(s.diameter_mm, sleeve.inner_diameter_mm);
        try {
            Rod rod(wire, sleeve, {}, 300.0 * draw(seed, 7), 300.0 * draw(seed, 9));
            operate(rod, seed, 100);
        } catch (const UserError&) {
            ++refused;
        }
        if (HasFatalFailure()) return;
    }
    std::printf("refused %d of 16\n", refused);
    EXPECT_LT(refused, 10);
}

}  // namespace
}  // namespace cathlab
