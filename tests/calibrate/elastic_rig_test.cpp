// The elastic wall with collagen, as a world that is stepped to rest, against its law on a thin tube.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "calibrate/rig_run.h"
#include "calibrate/wall_calibration.h"
#include "softbody/fibres.h"

namespace cathlab {
namespace {

struct Artery {
    double young_kpa = 75.0, poisson = 0.49;
    Fibres fibres{.stiffness_kpa = 18.0, .exponent = 1.2, .angle_deg = 7.0, .dispersion = 0.0, .onset = 0.0};
};

SceneSpec scene_of(const Artery& artery) {
    SceneSpec scene;
    scene.wall.form = "elastic";
    scene.wall.young_kpa = artery.young_kpa;
    scene.wall.poisson = artery.poisson;
    scene.effects = all_effects_off();
    for (SceneEffect& effect : scene.effects)
        if (effect.info->name == "stiffening") {
            effect.enabled = true;
            effect.values = {artery.fibres.stiffness_kpa, artery.fibres.exponent, artery.fibres.angle_deg,
                             artery.fibres.dispersion, artery.fibres.onset};
        }
    return scene;
}

WallRig rig() {
    WallRig out;
    out.shape.radius_mm = 8.0;
    out.shape.length_mm = 40.0;
    return out;
}

/// Cauchy stress round a thin tube of held length by its stretch, as the rig takes it: force over the section at rest
/// times the stretch.
double law(const Artery& artery, double strain) {
    const double l = 1.0 + strain, mu = artery.young_kpa / (2.0 * (1.0 + artery.poisson));
    const double a = artery.poisson / (1.0 - artery.poisson);
    const double h11 = 0.5 + artery.fibres.cosine(), h22 = 0.5 - artery.fibres.cosine();
    const double e = h11 * l * l + h22 - 1.0 - artery.fibres.onset;
    return (mu * (l - std::pow(l * l, -a) / l) + 4.0 * fibre_tension(artery.fibres, e).tension * h11 * l) * l;
}

double strain_by_law(const Artery& artery, double stress_kpa) {
    double low = 0.0, high = 2.0;
    for (int k = 0; k < 60; ++k) {
        const double middle = 0.5 * (low + high);
        (law(artery, middle) < stress_kpa ? low : high) = middle;
    }
    return low;
}

TEST(ElasticRig, ATubeWithCollagenStrainsByItsLaw) {
    const Artery artery;
    const std::vector<double> stress{20.0, 100.0, 200.0, 400.0, 580.0};
    const std::vector<double> found = rig_strain(rig(), scene_of(artery), stress).at(0);
    for (std::size_t i = 0; i < stress.size(); ++i) {
        const double wanted = strain_by_law(artery, stress[i]);
        std::printf("%4.0f kPa: strain %.5f, law %.5f\n", stress[i], found[i], wanted);
        EXPECT_NEAR(found[i], wanted, 0.004) << stress[i];
    }
}

TEST(ElasticRig, TheSwarmFindsModulusAndFibresOfAKnownCurve) {
    const Artery truth;
    StressStrain reference;
    for (double s = 50.0; s <= 550.0; s += 100.0) reference.stress_kpa.push_back(s);
    reference.strain = rig_strain(rig(), scene_of(truth), reference.stress_kpa).at(0);
    WallSearch search;
    Artery first;
    first.young_kpa = 200.0;
    first.fibres.stiffness_kpa = 40.0;
    search.scene = scene_of(first);
    search.rig = rig();
    search.free = {named_bound("wall.young_kpa", 30.0, 300.0), named_bound("effects.stiffening.fibre_kpa", 2.0, 60.0)};
    search.swarm.particles = 8;
    search.swarm.generations = 4;
    search.swarm.threads = 2;
    search.polish_evaluations = 40;
    const WallCalibration found = calibrate_wall(reference, search);
    EXPECT_LT(found.figures.rmse, 5e-4);
    EXPECT_LT(found.figures.rmse, 0.05 * found.figures_first.rmse);
    EXPECT_NEAR(found.values[0].second / truth.young_kpa, 1.0, 0.1);
    EXPECT_NE(found.overlay.find("[effects.stiffening]"), std::string::npos);
}

}  // namespace
}  // namespace cathlab
