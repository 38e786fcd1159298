#include "calibrate/wall_calibration.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/errors.h"
#include "scene/load_scene.h"
#include "scene/temporary_folder.h"

using namespace cathlab;

namespace {

/// Narrow and coarse: quick, and as good for whatever does not ask for an aorta.
WallRig quick_rig(RigStress stress = RigStress::hoop) {
    WallRig rig;
    rig.shape.radius_mm = 8.0;
    rig.shape.length_mm = 36.0;
    rig.stress = stress;
    return rig;
}

SceneSpec scene_of(double stiffness) {
    SceneSpec scene;
    scene.wall.cluster_stiffness = stiffness;
    return scene;
}

/// Strain of a rig that has one gauge.
std::vector<double> pressure_strain(const WallRig& rig, const SceneSpec& scene, const std::vector<double>& stress) {
    return rig_strain(rig, scene, stress).at(0);
}

/// A reference made by the rig itself with a known stiffness.
StressStrain reference(double stiffness, RigStress stress = RigStress::hoop) {
    StressStrain out;
    out.stress_kpa = {20.0, 40.0, 60.0};
    out.strain = pressure_strain(quick_rig(stress), scene_of(stiffness), out.stress_kpa);
    return out;
}

WallSearch search_for_stiffness() {
    WallSearch search;
    search.free = {named_bound("wall.cluster_stiffness", 0.4, 0.95)};
    search.rig = quick_rig();
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
        EXPECT_GT(curve.strain[2], 2.0 * curve.strain[0]);
    }
    EXPECT_GT(soft.strain[2], 1.5 * hard.strain[2]);
}

TEST(PressureRig, ATubeWithoutPressureStaysAsItIs) {
    const std::vector<double> none{0.0};
    EXPECT_NEAR(pressure_strain(quick_rig(), SceneSpec{}, none)[0], 0.0, 1e-7);
}

TEST(PressureRig, TheOrderOfTheLoadsIsOfNoConsequence) {
    const SceneSpec scene = scene_of(0.8);
    const std::vector<double> up{20.0, 60.0, 120.0}, down{120.0, 20.0, 60.0};
    const std::vector<double> a = pressure_strain(quick_rig(), scene, up);
    const std::vector<double> b = pressure_strain(quick_rig(), scene, down);
    EXPECT_NEAR(a[0], b[1], 2e-4);
    EXPECT_NEAR(a[1], b[2], 2e-4);
    EXPECT_NEAR(a[2], b[0], 2e-4);
}

TEST(PressureRig, TheTrueStressIsTheNominalOneTimesTheStretch) {
    const SceneSpec scene = scene_of(0.7);
    const double nominal = pressure_strain(quick_rig(RigStress::nominal), scene, std::vector{50.0})[0];
    const std::vector<double> same{50.0 * (1.0 + nominal)};
    EXPECT_NEAR(pressure_strain(quick_rig(RigStress::hoop), scene, same)[0], nominal, 2e-4);
}

TEST(PressureRig, ThePapersStressIsATractionAndPushesByRadiusOverThicknessMore) {
    const SceneSpec scene = scene_of(0.8);
    const WallRig rig = quick_rig(RigStress::paper);
    const double more = rig.shape.radius_mm / rig.thickness_mm;
    const double paper = pressure_strain(rig, scene, std::vector{5.0})[0];
    EXPECT_NEAR(pressure_strain(quick_rig(RigStress::nominal), scene, std::vector{5.0 * more})[0], paper, 1e-6);
}

TEST(PressureRig, IsTheTubeOfTheRigsScene) {
    const SceneSpec scene =
        load_scene(std::string(CATHLAB_SOURCE_DIR) + "/scenes/rigs/stress_strain.toml", {}, CATHLAB_SOURCE_DIR);
    const WallRig rig = wall_rig(scene);
    EXPECT_EQ(rig.kind, RigKind::tube);
    EXPECT_NEAR(rig.shape.radius_mm, 12.0, 1e-12);
    EXPECT_NEAR(rig.shape.length_mm, 80.0, 1e-12);
    EXPECT_NEAR(rig.thickness_mm, 1.0, 1e-12);
    SceneSpec demo = load_scene(std::string(CATHLAB_SOURCE_DIR) + "/scenes/demo.toml", {}, CATHLAB_SOURCE_DIR);
    for (const char* kind : {"tube", "ring", "strip", "block"}) {
        demo.rig.kind = kind;
        EXPECT_NE(error_sentence([&] { wall_rig(demo); }).find("one straight vessel"), std::string::npos);
    }
}

TEST(WallCalibration, FindsTheStiffnessThatMadeTheReference) {
    const double truth = 0.72;
    const WallCalibration found = calibrate_wall(reference(truth), search_for_stiffness());
    ASSERT_EQ(found.values.size(), 1U);
    EXPECT_NEAR(found.values[0].second, truth, 0.003);
    EXPECT_LT(found.figures.rmse, 0.02 * found.figures_first.rmse);
    EXPECT_NE(found.overlay.find("[wall]\ncluster_stiffness = 0.7"), std::string::npos);
}

TEST(WallCalibration, TheNumberOfThreadsDoesNotChangeABit) {
    WallSearch search = search_for_stiffness();
    search.polish_evaluations = 0;
    search.swarm.generations = 1;
    const StressStrain curve = reference(0.7);
    const WallCalibration two = calibrate_wall(curve, search);
    search.swarm.threads = 1;
    const WallCalibration one = calibrate_wall(curve, search);
    EXPECT_EQ(one.values, two.values);
    EXPECT_EQ(one.best_history, two.best_history);
    EXPECT_EQ(one.overlay, two.overlay);
}

TEST(WallCalibration, KeepsTheBestWhenItIsStopped) {
    WallSearch search = search_for_stiffness();
    search.swarm.on_generation = [](const SearchProgress&) { return false; };
    const WallCalibration found = calibrate_wall(reference(0.7), search);
    EXPECT_TRUE(found.stopped);
    EXPECT_LE(found.figures.rmse, found.figures_first.rmse);
}

TEST(WallCalibration, ALongRecordingIsFollowedAsItsCurveIs) {
    const StressStrain curve = reference(0.7);
    StressStrain recording;  // three runs up and down between the same points
    for (int run = 0; run < 3; ++run)
        for (int i = 0; i <= 50; ++i) {
            const double t = 2.0 * (run == 1 ? 50 - i : i) / 50.0;
            const auto below = std::min<std::size_t>(1, static_cast<std::size_t>(t));
            recording.run.push_back(run);
            recording.stress_kpa.push_back(20.0 + 20.0 * t);
            recording.strain.push_back(curve.strain[below] + (t - static_cast<double>(below)) *
                                                                 (curve.strain[below + 1] - curve.strain[below]));
        }
    EXPECT_LT(strain_error(recording, quick_rig(), scene_of(0.7)), 1e-3);
}

TEST(WallCalibration, RefusesReferencesAndNamesThatMakeNoSense) {
    const WallSearch search = search_for_stiffness();
    const auto complaint = [&](const StressStrain& curve) {
        return error_sentence([&] { calibrate_wall(curve, search); });
    };
    const auto curve = [](std::vector<double> stress, std::vector<double> strain) {
        StressStrain out;
        out.stress_kpa = std::move(stress);
        out.strain = std::move(strain);
        return out;
    };
    EXPECT_NE(complaint(curve({10.0}, {0.1})).find("1 row"), std::string::npos);
    EXPECT_NE(complaint(curve({10.0, 20.0, 30.0}, {0.1})).find("one length"), std::string::npos);
    EXPECT_NE(complaint(curve({10.0, 20.0, 15.0}, {0.1, 0.2, 0.3})).find("turns round"), std::string::npos);
    EXPECT_NE(complaint(curve({10.0, 20.0, std::nan("")}, {0.1, 0.2, 0.3})).find("not finite"), std::string::npos);
    EXPECT_NE(complaint(curve({-10.0, 0.0, 10.0}, {-0.1, 0.0, 0.1})).find("0 or more"), std::string::npos);

    const StressStrain fine = curve({10.0, 20.0, 30.0}, {0.1, 0.2, 0.3});
    const auto with = [&](const Bound& bound) {
        WallSearch other = search;
        other.free = {bound};
        return error_sentence([&] { calibrate_wall(fine, other); });
    };
    EXPECT_NE(with({0.0, 1.0, "wall.cluster_stifness"}).find("wall.cluster_stiffness"), std::string::npos);
    EXPECT_NE(with({0.0, 1.0, "wall.friction"}).find("does not change a wall"), std::string::npos);
    EXPECT_NE(with({0.9, 0.1, "wall.cluster_stiffness"}).find("turned round"), std::string::npos);
}

TEST(WallCalibration, WhereNoClusterReachesItSaysWhichSpacingAndRadiusWould) {
    WallSearch search = search_for_stiffness();
    search.free = {named_bound("wall.cluster_radius_mm", 0.5, 1.0)};
    StressStrain curve;
    curve.stress_kpa = {10.0, 20.0, 30.0};
    curve.strain = {0.1, 0.2, 0.3};
    const std::string sentence = error_sentence([&] { calibrate_wall(curve, search); });
    EXPECT_NE(sentence.find("radius"), std::string::npos) << sentence;
    EXPECT_NE(sentence.find("spacing"), std::string::npos) << sentence;
}
