#include "calibrate/heart_calibration.h"

#include <gtest/gtest.h>

#include <cmath>

#include "scene/load_scene.h"
#include "scene/temporary_folder.h"

using namespace cathlab;

namespace {

SceneSpec fork_scene() {
    return load_scene(std::string(CATHLAB_SOURCE_DIR) + "/scenes/rigs/fork.toml", {}, CATHLAB_SOURCE_DIR);
}

/// Towards the apex by `depth_mm` in the middle of the beat, smoothly.
BeatMotion dip(double depth_mm) {
    BeatMotion out;
    for (int i = 0; i < 40; ++i) {
        const double phase = i / 40.0;
        out.phase.push_back(phase);
        out.displacement_mm.push_back(0.5 * depth_mm * (1.0 - std::cos(2.0 * M_PI * phase)));
    }
    return out;
}

class Heart : public testing::Test {
protected:
    static void SetUpTestSuite() { models = build_models(heart_scene(fork_scene()), {2, "", {}}); }
    static void TearDownTestSuite() { models.reset(); }

    static HeartSearch search() {
        HeartSearch out;
        out.scene = fork_scene();
        out.target = annulus_target(dip(8.0), true);
        out.knots = 8;
        out.beats = 1;
        out.reach_mm = 0.3;
        out.swarm.particles = 3;
        out.swarm.generations = 1;
        out.swarm.threads = 2;
        return out;
    }
    static std::shared_ptr<const SceneModels> models;
};
std::shared_ptr<const SceneModels> Heart::models;

}  // namespace

TEST(AnnulusTarget, IsZeroWhereTheAnnulusStandsNearestToTheApex) {
    const AnnulusTarget target = annulus_target(dip(8.0), true);
    EXPECT_NEAR(target.rest_phase, 0.5, 1e-12);
    EXPECT_NEAR(at_phase(target.motion, 0.5), 0.0, 1e-12);
    EXPECT_NEAR(at_phase(target.motion, 0.0), 8.0, 1e-12);
    const AnnulusTarget other = annulus_target(dip(8.0), false);
    EXPECT_NEAR(other.rest_phase, 0.0, 1e-12);
    EXPECT_NEAR(at_phase(other.motion, 0.5), 8.0, 1e-12);
}

TEST(AnnulusTarget, RestsInTheMiddleOfAPlateau) {
    BeatMotion motion{{0.0, 0.2, 0.4, 0.5, 0.6, 0.8}, {0.0, 3.0, 5.0, 5.0, 5.0, 2.0}, "", {}};
    EXPECT_NEAR(annulus_target(motion, true).rest_phase, 0.5, 1e-12);
}

TEST_F(Heart, TheAnnulusFollowsTheReferenceOverTheBeat) {
    const HeartCalibration found = calibrate_heart(search(), *models);
    EXPECT_GT(found.figures_first.rmse, 1.0);
    EXPECT_LT(found.figures.rmse, 0.2);
    EXPECT_LT(found.figures.mean_absolute, 0.15);
    EXPECT_LE(found.figures.rmse, found.figures_start.rmse);
    EXPECT_EQ(found.profile.size(), 8U);
    EXPECT_EQ(found.best_history.size(), 2U);
}

TEST_F(Heart, TheOverlayGivesTheSameMotionInAnyScene) {
    const HeartSearch asked = search();
    const HeartCalibration found = calibrate_heart(asked, *models);
    const TemporaryFolder folder;
    const std::string overlay = folder.write("overlay.toml", found.overlay);
    const SceneSpec scene =
        load_scene(std::string(CATHLAB_SOURCE_DIR) + "/scenes/rigs/fork.toml", {overlay}, CATHLAB_SOURCE_DIR);
    const AnnulusMotion again = annulus_motion(heart_scene(scene), *models, asked.beats, 1);
    EXPECT_EQ(again.z_mm, found.motion.z_mm);
}

TEST_F(Heart, TheNumberOfThreadsDoesNotChangeABit) {
    HeartSearch asked = search();
    const HeartCalibration two = calibrate_heart(asked, *models);
    asked.swarm.threads = 1;
    const HeartCalibration one = calibrate_heart(asked, *models);
    EXPECT_EQ(one.overlay, two.overlay);
    EXPECT_EQ(one.best_history, two.best_history);
}

TEST_F(Heart, ThePeaksAreMetWhereTheyAreTheObjective) {
    HeartSearch asked = search();
    asked.at_peaks = true;
    const HeartCalibration found = calibrate_heart(asked, *models);
    double low = 1e9, high = -1e9;
    for (const double z : found.motion.z_mm) {
        low = std::min(low, z);
        high = std::max(high, z);
    }
    EXPECT_NEAR(low, 0.0, 0.3);
    EXPECT_NEAR(high, 8.0, 0.3);
}

TEST_F(Heart, KeepsTheBestWhenItIsStoppedAndSaysSoWhereThereIsNone) {
    HeartSearch asked = search();
    int runs = 0;
    asked.on_simulation = [&](int n) { runs = n; };
    asked.stop = [&] { return runs >= 3; };
    const HeartCalibration found = calibrate_heart(asked, *models);
    EXPECT_TRUE(found.stopped);
    EXPECT_LT(found.figures.rmse, found.figures_first.rmse);
    asked.stop = [] { return true; };
    EXPECT_NE(error_sentence([&] { calibrate_heart(asked, *models); }).find("stopped before"), std::string::npos);
}

TEST_F(Heart, RefusesWhatMakesNoSense) {
    HeartSearch asked = search();
    asked.knots = 2;
    EXPECT_NE(error_sentence([&] { calibrate_heart(asked, *models); }).find("knots"), std::string::npos);
    asked = search();
    asked.reach_mm = std::nan("");
    EXPECT_NE(error_sentence([&] { calibrate_heart(asked, *models); }).find("reach"), std::string::npos);
    asked = search();
    asked.scene.heart.enabled = false;
    EXPECT_NE(error_sentence([&] { calibrate_heart(asked, *models); }).find("no heart"), std::string::npos);
    asked = search();
    asked.target.motion.phase.clear();
    EXPECT_NE(error_sentence([&] { calibrate_heart(asked, *models); }), "no error");
}
