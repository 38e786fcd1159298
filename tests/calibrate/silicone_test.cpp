// The measured silicones as references, where they are: compression of a cylinder, on the block.
#include <gtest/gtest.h>

#include <filesystem>

#include "calibrate/wall_calibration.h"
#include "scene/load_scene.h"
#include "scene/temporary_folder.h"

namespace cathlab {
namespace {

class Silicone : public testing::TestWithParam<const char*> {
protected:
    void SetUp() override {
        file_ = std::string(CATHLAB_SHARED_DATA) + "/measured/" + GetParam() + "/data.csv";
        if (!std::filesystem::exists(file_)) GTEST_SKIP() << "the measured silicone is not here: " << file_;
    }
    SceneSpec block() const {
        return load_scene(std::string(CATHLAB_SOURCE_DIR) + "/scenes/rigs/block.toml", {}, CATHLAB_SOURCE_DIR);
    }
    std::string file_;
};

TEST_P(Silicone, IsAReferenceForTheBlockAloneAndAnElasticWallFollowsItsBeginning) {
    const StressStrain all = read_stress_strain(file_);
    EXPECT_EQ(all.strain.size(), 1500U);
    const StressStrain reference = within(all, GetParam() == std::string("silicone-ef10-0t") ? -6.0 : -11.0, 0.0);
    WallSearch search;
    search.scene = block();
    search.scene.wall.form = "elastic";
    search.rig = wall_rig(search.scene);
    search.rig.stress = RigStress::nominal;
    search.free = {named_bound("wall.young_kpa", 5.0, 200.0)};
    search.swarm.particles = 4;
    search.swarm.generations = 2;
    search.swarm.threads = 2;
    search.polish_evaluations = 12;
    const WallCalibration found = calibrate_wall(reference, search);
    EXPECT_LT(found.figures.rmse, 0.01) << found.values[0].second << " kPa";

    WallRig tube;
    tube.stress = RigStress::nominal;
    const std::string sentence = error_sentence([&] { check_against(reference, tube); });
    EXPECT_NE(sentence.find("data.csv:2"), std::string::npos) << sentence;
    EXPECT_NE(sentence.find("block"), std::string::npos) << sentence;
}

INSTANTIATE_TEST_SUITE_P(Measured, Silicone, testing::Values("silicone-ef10-0t", "silicone-ef30-0t"));

}  // namespace
}  // namespace cathlab
