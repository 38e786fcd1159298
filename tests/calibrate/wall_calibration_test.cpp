#include "calibrate/wall_calibration.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/errors.h"

using namespace cathlab;

namespace {

/// A reference made by the rig itself with a known stiffness.
StressStrain reference(double stiffness) {
    WallParameters wall = wall_parameters(SceneWall{});
    wall.cluster_stiffness = stiffness;
    StressStrain out;
    out.stress_kpa = {20.0, 60.0};
    out.strain = pressure_strain(PressureRig{}, wall, out.stress_kpa);
    return out;
}

WallSearch search_for_stiffness() {
    WallSearch search;
    search.free = {named_bound("wall.cluster_stiffness", 0.4, 0.95)};
    search.swarm.particles = 6;
    search.swarm.generations = 4;
    search.swarm.threads = 2;
    search.polish_evaluations = 25;
    return search;
}

}  // namespace

TEST(PressureRig, StrainRisesWithStressAndFallsWithStiffness) {
    const StressStrain soft = reference(0.6), hard = reference(0.85);
    for (const StressStrain& curve : {soft, hard}) {
        EXPECT_GT(curve.strain[0], 0.0);
        EXPECT_GT(curve.strain[1], 2.0 * curve.strain[0]);
    }
    EXPECT_GT(soft.strain[1], 1.5 * hard.strain[1]);
}

TEST(PressureRig, ATubeWithoutPressureStaysAsItIs) {
    const std::vector<double> none{0.0};
    EXPECT_NEAR(pressure_strain(PressureRig{}, wall_parameters(SceneWall{}), none)[0], 0.0, 1e-9);
}

TEST(WallCalibration, FindsTheStiffnessThatMadeTheReference) {
    const double truth = 0.72;
    const WallCalibration found = calibrate_wall(reference(truth), search_for_stiffness());
    ASSERT_EQ(found.values.size(), 1U);
    EXPECT_NEAR(found.values[0].second, truth, 0.003);
    EXPECT_LT(found.rmse, 0.02 * found.rmse_first);
    EXPECT_NE(found.overlay.find("[wall]\ncluster_stiffness = 0.7"), std::string::npos);
}

TEST(WallCalibration, KeepsTheBestWhenItIsStopped) {
    WallSearch search = search_for_stiffness();
    search.swarm.on_generation = [](const Progress&) { return false; };
    const WallCalibration found = calibrate_wall(reference(0.7), search);
    EXPECT_TRUE(found.stopped);
    EXPECT_LE(found.rmse, found.rmse_first);
}

TEST(WallCalibration, RefusesReferencesAndNamesThatMakeNoSense) {
    const WallSearch search = search_for_stiffness();
    EXPECT_THROW(calibrate_wall({{10.0}, {0.1}}, search), UserError);
    EXPECT_THROW(calibrate_wall({{10.0, 20.0}, {0.1}}, search), UserError);
    EXPECT_THROW(calibrate_wall({{10.0, 5.0}, {0.1, 0.2}}, search), UserError);
    EXPECT_THROW(calibrate_wall({{10.0, std::nan("")}, {0.1, 0.2}}, search), UserError);
    WallSearch other = search;
    other.free = {Bound{0.0, 1.0, "wall.cluster_stifness"}};
    try {
        calibrate_wall({{10.0, 20.0}, {0.1, 0.2}}, other);
        FAIL();
    } catch (const UserError& e) {
        EXPECT_NE(std::string(e.what()).find("did you mean 'wall.cluster_stiffness'"), std::string::npos);
    }
}
