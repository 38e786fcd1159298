// The wall's elastic form: the solver's loops against the shell that they stand for, and what the stepped wall comes
// to.
#include "softbody/elastic.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "core/units.h"
#include "rig.h"
#include "softbody/shell_statics.h"

namespace cathlab {
namespace {

WallParameters elastic(double young_kpa = 500.0, double poisson = 0.45) {
    WallParameters p;
    p.form = WallForm::elastic;
    p.young_kpa = young_kpa;
    p.poisson = poisson;
    return p;
}

constexpr Fibres collagen{.stiffness_kpa = 40.0, .exponent = 3.0, .angle_deg = 25.0, .dispersion = 0.1, .onset = 0.02};

struct Pulled {
    std::vector<Vec3> force;
    std::vector<double> tangent;
};

Pulled pulled(const kernel::Set& set, const SoftBodyModel& model, const Fibres& fibres, const double* scale,
              const std::vector<Vec3>& x) {
    const ElasticGroups& groups = model.elastic;
    AlignedVector<double> slot(groups.slots() * 3 * kernel::lanes, 0.0);
    Pulled out;
    out.tangent.resize(groups.groups() * kernel::lanes);
    set.shell_forces(groups.view(fibres, scale), x.front().data(), slot.data(), out.tangent.data(), 0, groups.groups());
    std::vector<Vec3> goal(model.size());
    const std::vector<double> one(model.size(), 1.0);
    const std::vector<Vec3> origin(model.size(), Vec3::Zero());
    set.shell_goals(groups.sources(), slot.data(), origin.front().data(), one.data(), goal.front().data(), 0,
                    model.size());
    out.force = std::move(goal);
    return out;
}

TEST(ElasticWall, TheLoopsPullAsTheShellDoes) {
    const SoftBodyModel model = build_soft_body(rig::sample(6.0, 20.0, false), elastic(), nullptr);
    std::vector<Vec3> x = model.rest;
    for (std::size_t i = 0; i < x.size(); ++i) x[i] = 1.1 * x[i] + rig::random_vector(i, 0.3);
    for (const Fibres& fibres : {Fibres{}, collagen}) {
        std::vector<Vec3> wanted(x.size(), Vec3::Zero());
        add_shell_forces(model.shell, x, wanted, fibres);
        const Pulled wide = pulled(kernel::best(), model, fibres, nullptr, x);
        double size = 0.0, worst = 0.0;
        for (std::size_t i = 0; i < x.size(); ++i) {
            size = std::max(size, wanted[i].norm());
            worst = std::max(worst, (wanted[i] - wide.force[i]).norm());
        }
        EXPECT_LT(worst, 1e-11 * size);
        const Pulled narrow = pulled(kernel::baseline(), model, fibres, nullptr, x);
        for (std::size_t i = 0; i < x.size(); ++i) ASSERT_EQ(narrow.force[i], wide.force[i]);
        EXPECT_EQ(narrow.tangent, wide.tangent);
        const std::vector<double> twice(x.size(), 2.0);
        const Pulled scaled = pulled(kernel::best(), model, fibres, twice.data(), x);
        for (std::size_t i = 0; i < x.size(); ++i)
            ASSERT_LT((scaled.force[i] - 2.0 * wide.force[i]).norm(), 1e-11 * size);
        for (std::size_t k = 0; k < wide.tangent.size(); ++k)
            ASSERT_NEAR(scaled.tangent[k], 2.0 * wide.tangent[k], 1e-12 * scaled.tangent[k]);
    }
}

constexpr double length = 100.0;
bool at_ends(const Vec3& p) {
    return p.z() < 1.5 || p.z() > length - 1.5;
}

rig::Wall held_tube(const WallParameters& parameters = elastic()) {
    return rig::Wall(build_soft_body(rig::sample(12.0, length, false), parameters, at_ends));
}

/// Steps until the wall stands still.  Whenever its motion slows down it has passed an equilibrium on some way, and is
/// stopped there: that moves no equilibrium.
void settle(rig::Wall& wall, double h, int iterations, std::span<const Vec3> load, double still_mm = 3e-6) {
    constexpr int look = 20, most = 6000;
    double last = 0.0;
    for (int k = 0; k < most; ++k) {
        const std::vector<Vec3> before = k % look == 0 ? wall.state.x : std::vector<Vec3>{};
        wall.step(h, iterations, {}, load);
        const double now = kinetic_energy(wall.model, wall.state);
        const bool slower = now < last;
        last = slower ? 0.0 : now;
        if (slower) wall.state.v.assign(wall.model.size(), Vec3::Zero());
        double moved = 0.0;
        for (std::size_t i = 0; i < before.size(); ++i) moved = std::max(moved, (wall.state.x[i] - before[i]).norm());
        if (!before.empty() && k > 0 && moved < still_mm) return;
    }
    ADD_FAILURE() << "no rest in " << most << " steps";
}

/// Forces of a pressure on the areas at rest, along the radius at rest.
std::vector<Vec3> radial_load(const SoftBodyModel& model, double pressure_kpa) {
    const WallSample sample = rig::sample(12.0, length, false);
    std::vector<Vec3> load;
    for (std::size_t i = 0; i < model.size(); ++i) {
        Vec3 radial = model.rest[i];
        radial.z() = 0.0;
        load.push_back(model.fixed[i] ? Vec3(Vec3::Zero())
                                      : Vec3(pressure_kpa * sample.area_mm2[i] * radial.normalized()));
    }
    return load;
}

double strain(const SoftBodyModel& model, std::span<const Vec3> x) {
    double sum = 0.0;
    int count = 0;
    for (std::size_t i = 0; i < model.size(); ++i) {
        if (std::fabs(model.rest[i].z() - 0.5 * length) > 15.0) continue;
        sum += x[i].head<2>().norm() / model.rest[i].head<2>().norm() - 1.0;
        ++count;
    }
    return sum / count;
}

double settled_strain(const WallParameters& parameters, double pressure_kpa, double h, int iterations) {
    rig::Wall wall = held_tube(parameters);
    settle(wall, h, iterations, radial_load(wall.model, pressure_kpa));
    return strain(wall.model, wall.state.x);
}

TEST(ElasticWall, ItComesToRestWhereTheShellDoes) {
    rig::Wall wall = held_tube();
    const std::vector<Vec3> load = radial_load(wall.model, 4.0);
    settle(wall, 0.005, 1, load);
    std::vector<Vec3> x = wall.model.rest;
    ASSERT_TRUE(shell_equilibrium(wall.model.shell, wall.model.fixed, dead_load(load), x));
    double worst = 0.0, largest = 0.0;
    for (std::size_t i = 0; i < x.size(); ++i) {
        worst = std::max(worst, (x[i] - wall.state.x[i]).norm());
        largest = std::max(largest, (x[i] - wall.model.rest[i]).norm());
    }
    EXPECT_LT(worst, 2e-3 * largest);
    EXPECT_NEAR(strain(wall.model, wall.state.x) / strain(wall.model, x), 1.0, 2e-4);
}

TEST(ElasticWall, StepIterationsAndClustersDoNotChangeTheStrain) {
    const double one = settled_strain(elastic(), 4.0, 0.005, 1);
    EXPECT_NEAR(settled_strain(elastic(), 4.0, 0.0025, 1) / one, 1.0, 1e-3);
    EXPECT_NEAR(settled_strain(elastic(), 4.0, 0.005, 2) / one, 1.0, 1e-3);
    EXPECT_NEAR(settled_strain(elastic(), 4.0, 0.02, 4) / one, 1.0, 1e-3);
    for (const double radius : {6.0, 9.0}) {
        WallParameters other = elastic();
        other.cluster_radius_mm = radius;
        other.cluster_spacing_mm = radius / 1.5;
        EXPECT_NEAR(settled_strain(other, 4.0, 0.005, 1) / one, 1.0, 1e-3) << radius;
    }
}

TEST(ElasticWall, ATubeUnderPressureStrainsByThinWallTheory) {
    // Held length: plane strain along the axis.  The load is by the areas at rest: sigma (1 + e) t0 (r0 / r) .. = p r0,
    // that is, the first Piola-Kirchhoff stress is p r0 / t0.
    const double young = 500.0, nu = 0.45, mu = young / (2.0 * (1.0 + nu)), a = nu / (1.0 - nu), p = 2.0;
    double low = 1.0, high = 2.0;
    for (int k = 0; k < 60; ++k) {
        const double l = 0.5 * (low + high);
        (mu * (l - std::pow(l * l, -a) / l) < p * 12.0 ? low : high) = l;
    }
    const double found = settled_strain(elastic(young, nu), p, 0.005, 1);
    std::printf("strain %.5f, thin wall %.5f\n", found, low - 1.0);
    EXPECT_NEAR(found / (low - 1.0), 1.0, 0.02);
}

TEST(ElasticWall, ARegionOfTwiceTheModulusStrainsHalf) {
    WallSample sample = rig::sample(12.0, length, false);
    for (std::size_t i = 0; i < sample.region.size(); ++i) sample.region[i] = sample.position[i].z() > 0.5 * length;
    WallParameters parameters = elastic();
    RegionWall& stiff = parameters.regions.emplace_back();
    stiff.region = 1;
    stiff.young_kpa = 1000.0;
    rig::Wall wall(build_soft_body(sample, parameters, at_ends));
    settle(wall, 0.005, 1, radial_load(wall.model, 1.0));
    double sum[2] = {}, count[2] = {};
    for (std::size_t i = 0; i < wall.model.size(); ++i) {
        const double z = wall.model.rest[i].z();
        if (std::fabs(std::fabs(z - 0.5 * length) - 25.0) > 5.0) continue;
        const std::size_t half = z > 0.5 * length;
        sum[half] += wall.state.x[i].head<2>().norm() / wall.model.rest[i].head<2>().norm() - 1.0;
        count[half] += 1.0;
    }
    EXPECT_NEAR(sum[0] / count[0] / (sum[1] / count[1]), 2.0, 0.06);
}

TEST(ElasticWall, FreeItFallsAndTurnsAsARigidBody) {
    WallParameters parameters = elastic();
    parameters.damping_per_s = 50.0;
    rig::Wall wall(build_soft_body(rig::sample(), parameters, nullptr));
    const Vec3 spin(0.0, 3.0, 0.0), pull(0.0, 0.0, -9806.65);
    std::vector<Vec3> weight;
    for (std::size_t i = 0; i < wall.model.size(); ++i) {
        wall.state.v[i] = spin.cross(wall.model.rest[i] - Vec3(0, 0, 30));
        weight.emplace_back(wall.model.mass[i] * pull);
    }
    const Vec3 linear = linear_momentum(wall.model, wall.state), angular = angular_momentum(wall.model, wall.state);
    double mass = 0.0;
    Vec3 moment = Vec3::Zero();
    for (std::size_t i = 0; i < wall.model.size(); ++i) {
        mass += wall.model.mass[i];
        moment += wall.model.mass[i] * wall.model.rest[i];
    }
    constexpr double h = 0.002;
    constexpr int steps = 100;
    for (int k = 0; k < steps; ++k) wall.step(h, 2, weight);
    const Vec3 fallen = linear_momentum(wall.model, wall.state) - linear;
    EXPECT_LT((fallen - steps * h * mass * pull).norm(), 1e-9 * fallen.norm());
    // About the point from which it fell, gravity through the centre of mass adds only what that point's fall gives.
    rig::Wall still(build_soft_body(rig::sample(), parameters, nullptr));
    for (std::size_t i = 0; i < still.model.size(); ++i)
        still.state.v[i] = spin.cross(still.model.rest[i] - Vec3(0, 0, 30));
    for (int k = 0; k < steps; ++k) still.step(h, 2);
    EXPECT_LT((angular_momentum(still.model, still.state) - angular).norm(), 1e-9 * angular.norm());
    // A turn of 0.6 rad: damping against the clusters has not slowed it.
    const Quat turn = det::rotation_from_vector(steps * h * spin);
    double worst = 0.0;
    for (std::size_t i = 0; i < still.model.size(); ++i)
        worst = std::max(worst,
                         (still.state.x[i] - (turn * (still.model.rest[i] - Vec3(0, 0, 30)) + Vec3(0, 0, 30))).norm());
    std::printf("after a turn of %.2f rad the tube is off its rigid place by %.4f mm\n", steps * h * spin.norm(),
                worst);
    EXPECT_LT(worst, 0.1);
}

TEST(ElasticWall, LetGoItsEnergyNeverRises) {
    // What moves is the mass, and k h^2 of it in this scheme: at the short step hardly any.
    for (const double h : {1e-5, 1e-4, 0.005})
        for (const double damping : {0.0, 10.0}) {
            WallParameters parameters = elastic();
            parameters.damping_per_s = damping;
            rig::Wall wall = held_tube(parameters);
            for (std::size_t i = 0; i < wall.model.size(); ++i)
                if (!wall.model.fixed[i])
                    wall.state.x[i].head<2>() *= 1.0 + 0.05 * std::sin(wall.model.rest[i].z() / length * units::pi);
            wall.step(1e-9, 1);  // the clusters come to where the wall was taken
            wall.state.v.assign(wall.model.size(), Vec3::Zero());
            double last = elastic_energy(wall.model, wall.state, wall.scratch), rise = 0.0;
            const double first = last;
            for (int k = 0; k < 300; ++k) {
                wall.step(h, 1);
                double energy = elastic_energy(wall.model, wall.state, wall.scratch);
                for (std::size_t i = 0; i < wall.model.size(); ++i)
                    energy +=
                        0.5 * (wall.model.mass[i] + wall.model.stiffness[i] * h * h) * wall.state.v[i].squaredNorm();
                rise = std::max(rise, energy - last);
                last = energy;
            }
            std::printf("h %g s, damping %g /s: %.1f of %.1f uJ are left, largest rise in a step %.2e\n", h, damping,
                        last, first, rise);
            EXPECT_LT(rise, 1e-6 * first);
        }
}

TEST(ElasticWall, FibresStiffenATubeByTheirOwnLaw) {
    // Incompressible, held length: first Piola-Kirchhoff stress 2 W'(l^2) l of matrix and both families.
    const double young = 75.0, nu = 0.4999, mu = young / (2.0 * (1.0 + nu)), p = 10.0;
    const Fibres fibres{.stiffness_kpa = 18.0, .exponent = 1.2, .angle_deg = 10.0, .dispersion = 0.05, .onset = 0.0};
    const double h11 = 0.5 + fibres.cosine(), h22 = 0.5 - fibres.cosine();
    double low = 1.0, high = 2.0;
    for (int k = 0; k < 60; ++k) {
        const double l = 0.5 * (low + high), e = h11 * l * l + h22 - 1.0;
        (mu * (l - 1.0 / (l * l * l)) + 4.0 * fibre_tension(fibres, e).tension * h11 * l < p * 12.0 ? low : high) = l;
    }
    rig::Wall wall = held_tube(elastic(young, nu));
    wall.scratch.fibres = fibres;
    settle(wall, 0.005, 1, radial_load(wall.model, p));
    const double found = strain(wall.model, wall.state.x);
    std::printf("with fibres: strain %.5f, thin wall %.5f\n", found, low - 1.0);
    EXPECT_NEAR(found / (low - 1.0), 1.0, 0.01);
}

}  // namespace
}  // namespace cathlab
