// Effects of the wall's material in the stepped solver against the closed form of a uniform specimen: the same law,
// asked at one point.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "calibrate/specimen.h"
#include "effects/effect.h"
#include "softbody/solver.h"
#include "softbody/uniaxial.h"

namespace cathlab {
namespace {

constexpr double young_kpa = 400.0, poisson = 0.49;
constexpr double h = 2e-3;

struct Acting {
    Acting(const char* name, const std::vector<double>& values) : effect(find_effect(name)->make(values)) {
        effect->fibres({}, fibres);
    }
    std::unique_ptr<Effect> effect;
    Fibres fibres;
};

using History = std::function<double(double t)>;  // kPa by the section at rest

WallParameters elastic_wall() {
    WallParameters parameters;
    parameters.form = WallForm::elastic;
    parameters.young_kpa = young_kpa;
    parameters.poisson = poisson;
    return parameters;
}

Specimen elastic_specimen(const WallRig& rig) {
    SceneWall scene;
    scene.form = "elastic";
    return make_specimen(rig, scene);
}

/// Strains at times k `every` of a block of particles that is stepped under the load.
std::vector<double> stepped(const char* name, const std::vector<double>& values, const History& load, double end_s,
                            int every) {
    Acting acting(name, values);
    WallRig rig;
    rig.kind = RigKind::block;
    rig.length_mm = rig.width_mm = 12.0;
    const Specimen specimen = elastic_specimen(rig);
    WallParameters parameters = elastic_wall();
    parameters.damping_per_s = 0.0;
    parameters.surrounding_kpa_s_per_mm = 1e-4;  // keeps a piece that nothing holds where it is
    const SoftBodyModel wall = build_soft_body(specimen.sample, parameters, {});
    SoftBodyState state = rest_state(wall);
    SoftBodyScratch scratch;
    scratch.fibres = acting.fibres;
    acting.effect->points(wall.elastic.groups() * kernel::lanes);
    const Workers workers(1);
    Effect* const effects[1] = {acting.effect.get()};
    std::vector<double> out;
    std::vector<Vec3> force(wall.size());
    const int steps = static_cast<int>(std::lround(end_s / h));
    for (int k = 1; k <= steps; ++k) {
        EffectContext context;
        context.time_s = (k - 1) * h;
        context.dt = h;
        const auto law = [&](const MembraneMaterial& material, MembranePoint& point) {
            ask_membrane(effects, context, material, scratch.fibres, point);
            acting.effect->remember(context, point);
        };
        ask_law(wall, state, scratch, law, workers);
        for (std::size_t i = 0; i < force.size(); ++i) force[i] = load(k * h) * specimen.gauges[0].push[i];
        predict(wall, state, scratch, h, force, workers);
        solve_and_apply(wall, state, scratch, h, 2, workers);
        finish(wall, state, scratch, h, workers);
        specimen.guide(state.x, state.v);
        for (Vec3& v : state.v) v *= 0.97;  // swings die out; the load is slow beside them
        if (k % every == 0) out.push_back(specimen.gauges[0].strain(state.x));
    }
    return out;
}

std::vector<double> closed(const char* name, const std::vector<double>& values, const History& load, double end_s,
                           int every) {
    Acting acting(name, values);
    acting.effect->points(1);
    const MembraneMaterial material{young_kpa / (2.0 * (1.0 + poisson)), poisson / (1.0 - poisson), Vec2(1.0, 0.0)};
    Effect* const effects[1] = {acting.effect.get()};
    std::vector<double> out;
    Uniaxial at;
    const int steps = static_cast<int>(std::lround(end_s / h));
    for (int k = 0; k <= steps; ++k) {
        EffectContext context;
        context.dt = k == 0 ? 0.0 : h;
        const auto law = [&](MembranePoint& p) { ask_membrane(effects, context, material, acting.fibres, p); };
        EXPECT_TRUE(uniaxial_rest(law, young_kpa, load(k * h), at)) << name << " at step " << k;
        MembranePoint point;
        point.c = Vec3(at.along * at.along, at.across * at.across, 0.0);
        law(point);
        acting.effect->remember(context, point);
        if (k > 0 && k % every == 0) out.push_back(at.along - 1.0);
    }
    return out;
}

/// Up, a halt, down to a third, a halt.
double up_and_down(double t) {
    constexpr double most = 90.0;
    if (t < 2.0) return most * t / 2.0;
    if (t < 3.0) return most;
    if (t < 4.5) return most * (1.0 - (t - 3.0) / 1.5 * (2.0 / 3.0));
    return most / 3.0;
}

void compare(const char* name, const std::vector<double>& values, double within) {
    const auto found = stepped(name, values, up_and_down, 5.0, 250),
               wanted = closed(name, values, up_and_down, 5.0, 250);
    ASSERT_EQ(found.size(), wanted.size());
    double largest = 0.0;
    for (const double w : wanted) largest = std::max(largest, std::fabs(w));
    for (std::size_t k = 0; k < found.size(); ++k)
        EXPECT_NEAR(found[k], wanted[k], within * largest)
            << name << " at " << 0.5 * static_cast<double>(k + 1) << " s";
}

TEST(WallEffects, AreTheSameInTheStepsAsInTheClosedForm) {
    compare("stiffening", {40.0, 1.5, 10.0, 0.2, 0.0}, 0.02);
    compare("slack", {0.05, 0.001}, 0.02);
    compare("creep", {0.1, 0.5, 2.0}, 0.02);
    compare("creep", {0.1, 0.5, 1.0}, 0.02);
    compare("entanglement", {0.5}, 0.02);
    compare("chain_limit", {0.3}, 0.02);
    compare("softening", {0.4, 0.6}, 0.02);
    compare("viscoelasticity", {0.5, 0.7, 2.0}, 0.02);
    compare("viscoelasticity", {0.5, 0.7, 1.0}, 0.02);
    // Nearer to Voigt's solid (share 1) what is held so firmly is slow in the steps beside the law: heavy particles.
    compare("viscoelasticity", {0.8, 0.7, 2.0}, 0.05);
}

/// A ring of radius R, width w and thickness t under a pressure p = stress t / R, in tissue of k, which holds it along
/// its axis too, so that its middle cannot narrow as it widens:
///     u / R = stress / (E' + k R^2 / t),   E' = E (1 - nu^2 tanh(a) / a) / (1 - nu^2),   a = w/2 sqrt((1 - nu^2) k /
///     (E t)).
TEST(WallEffects, ARingInTissueWidensByWhatRingAndTissueBearTogether) {
    WallRig rig;
    rig.kind = RigKind::ring;
    const Specimen specimen = elastic_specimen(rig);
    const SoftBodyModel wall = build_soft_body(specimen.sample, elastic_wall(), {});
    const Gauge& gauge = specimen.gauges[0];
    const Workers workers(1);
    const auto strain = [&](double tissue, double stress) {
        const auto effect = find_effect("tissue_support")->make(std::vector<double>{tissue});
        std::vector<double> around(wall.size(), 0.0);
        effect->surroundings({}, around);
        SoftBodyState state = rest_state(wall);
        SoftBodyScratch scratch;
        for (std::size_t i = 0; i < wall.size(); ++i) scratch.support.push_back(around[i] * wall.area_mm2[i]);
        std::vector<Vec3> force(wall.size());
        for (std::size_t i = 0; i < force.size(); ++i) force[i] = stress * gauge.push[i];
        for (int k = 0; k < 2000; ++k) {
            predict(wall, state, scratch, h, force, workers);
            solve_and_apply(wall, state, scratch, h, 2, workers);
            finish(wall, state, scratch, h, workers);
            if (specimen.guide) specimen.guide(state.x, state.v);
            for (Vec3& v : state.v) v *= 0.97;
        }
        return gauge.strain(state.x);
    };
    const double r = gauge.radius_mm, t = gauge.thickness_mm, stress = 8.0, square = poisson * poisson;
    const double bare = strain(0.0, stress), modulus = stress / bare;
    EXPECT_NEAR(modulus, young_kpa, 0.03 * young_kpa);
    double width = 0.0;
    for (const Vec3& p : wall.rest) width = std::max(width, std::fabs(p.z() - wall.rest[0].z()));
    for (const double tissue : {0.5, 2.0, 6.0}) {
        const double a = 0.5 * width * std::sqrt((1.0 - square) * tissue / (modulus * t));
        const double ring = modulus * (1.0 - square * std::tanh(a) / a) / (1.0 - square);
        const double wanted = stress / (ring + tissue * r * r / t);
        EXPECT_NEAR(strain(tissue, stress), wanted, 0.02 * wanted) << tissue;
    }
}

}  // namespace
}  // namespace cathlab
