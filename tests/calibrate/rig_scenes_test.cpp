// The rigs of scenes/rigs as a scene describes them, and what a scene may get wrong about one.
#include <gtest/gtest.h>

#include "calibrate/rig_run.h"
#include "calibrate/wall_calibration.h"
#include "scene/load_scene.h"
#include "scene/temporary_folder.h"

namespace cathlab {
namespace {

SceneSpec rig_scene(const std::string& name) {
    return load_scene(std::string(CATHLAB_SOURCE_DIR) + "/scenes/rigs/" + name + ".toml", {}, CATHLAB_SOURCE_DIR);
}

TEST(RigScenes, RingStripAndBlockAreCutFromTheirTube) {
    const WallRig ring = wall_rig(rig_scene("ring"));
    EXPECT_EQ(ring.kind, RigKind::ring);
    EXPECT_NEAR(ring.shape.radius_mm, 12.0, 1e-12);
    EXPECT_NEAR(ring.shape.length_mm, 10.0, 1e-12);
    const WallRig strip = wall_rig(rig_scene("strip"));
    EXPECT_EQ(strip.kind, RigKind::strip);
    EXPECT_NEAR(strip.length_mm, 60.0, 1e-12);
    EXPECT_NEAR(strip.thickness_mm, 1.0, 1e-12);
    const WallRig block = wall_rig(rig_scene("block"));
    EXPECT_EQ(block.kind, RigKind::block);
    EXPECT_NEAR(block.width_mm, 20.0, 1e-12);
    EXPECT_EQ(rig_scene("aorta").rig.stations.size(), 4U);
    EXPECT_EQ(gauge_names(ring), std::vector<std::string>{"ring"});
}

TEST(RigScenes, EveryRigGivesWayUnderItsLoad) {
    for (const char* name : {"stress_strain", "ring", "strip", "block"}) {
        const SceneSpec scene = rig_scene(name);
        const auto strain = rig_strain(wall_rig(scene), scene, std::vector<double>{5.0, 10.0}).at(0);
        EXPECT_GT(strain[0], 1e-3) << name;
        EXPECT_GT(strain[1], 1.5 * strain[0]) << name;
        EXPECT_LT(strain[1], 0.5) << name;
    }
}

TEST(RigScenes, OfATreeTheWideVesselHasAStationAndHeartAndBreathingLeaveItAlone) {
    SceneSpec scene = rig_scene("fork");  // its heart beats, and it breathes
    scene.rig.kind = "stations";
    scene.wall.particle_spacing_mm = 3.0;
    const WallRig rig = wall_rig(scene);
    ASSERT_EQ(gauge_names(rig), std::vector<std::string>{"trunk"});
    const std::vector<double> stress{20.0, 40.0};
    const auto strain = rig_strain(rig, scene, stress).at(0);
    EXPECT_GT(strain[0], 0.005);
    EXPECT_GT(strain[1], 1.5 * strain[0]);
    SceneSpec quiet = scene;
    quiet.heart.enabled = false;
    quiet.effects = all_effects_off();
    EXPECT_EQ(rig_strain(rig, quiet, stress).at(0), strain);
}

TEST(RigScenes, ABlockIsPressedAsItIsPulled) {
    const SceneSpec scene = rig_scene("block");
    WallRig rig = wall_rig(scene);
    rig.stress = RigStress::nominal;
    const auto pulled = rig_strain(rig, scene, std::vector<double>{1.0}).at(0);
    const auto pressed = rig_strain(rig, scene, std::vector<double>{-1.0}).at(0);
    EXPECT_GT(pulled[0], 0.0);
    EXPECT_NEAR(pressed[0] / pulled[0], -1.0, 0.05);
}

TEST(RigScenes, CompressionIsForABlockAloneAndTheErrorSaysSo) {
    StressStrain reference;
    reference.stress_kpa = {-1.0, -2.0, -3.0};
    reference.strain = {-0.01, -0.02, -0.03};
    reference.file = "silicone.csv";
    reference.line = {4, 5, 6};
    for (const char* name : {"stress_strain", "ring", "strip"}) {
        const std::string sentence = error_sentence([&] { check_against(reference, wall_rig(rig_scene(name))); });
        EXPECT_NE(sentence.find("silicone.csv:4"), std::string::npos) << sentence;
        EXPECT_NE(sentence.find("block.toml"), std::string::npos) << sentence;
        EXPECT_THROW(rig_strain(wall_rig(rig_scene(name)), SceneSpec{}, std::vector<double>{-1.0}), UserError);
    }
    EXPECT_NO_THROW(check_against(reference, wall_rig(rig_scene("block"))));
}

TEST(RigScenes, WhatASceneGetsWrongIsToldWithFileAndLine) {
    const TemporaryFolder folder;
    const std::string tube = std::string(CATHLAB_SOURCE_DIR) + "/scenes/rigs/stress_strain-anatomy.toml";
    const auto complaint = [&](const std::string& rig) {
        const std::string path =
            folder.write("rig.toml", "schema = 1\n[anatomy]\nfile = \"" + tube + "\"\n[rig]\n" + rig);
        return error_sentence([&] { wall_rig(load_scene(path, {}, CATHLAB_SOURCE_DIR)); });
    };
    const auto has = [](const std::string& sentence, const std::string& part) {
        EXPECT_NE(sentence.find(part), std::string::npos) << sentence;
    };
    has(complaint("kind = \"rung\"\n"), "ring");
    has(complaint("kind = \"ring\"\nlength_mm = 30.0\n"), "belongs to a strip or a block");
    has(complaint("kind = \"ring\"\nlength_mm = 30.0\n"), "rig.toml:4");
    has(complaint("kind = \"tube\"\nwidth_mm = 30.0\n"), "this rig is of kind tube");
    has(complaint("kind = \"strip\"\nlength_mm = 30.0\n"), "three widths");
    has(complaint("kind = \"strip\"\nwidth_mm = -3.0\n"), "from 1 to 500");
    has(complaint("kind = \"ring\"\n[[rig.station]]\nname = \"a\"\nregion = \"tube\"\n"), "kind stations");
    has(complaint("[[rig.station]]\nname = \"a\"\nregin = \"tube\"\n"), "region");
    has(complaint("[[rig.station]]\nregion = \"tube\"\n"), "name");
}

}  // namespace
}  // namespace cathlab
