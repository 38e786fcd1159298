#include "calibrate/named_parameters.h"

#include <gtest/gtest.h>

#include "core/errors.h"
#include "scene/scene_table.h"

using namespace cathlab;

namespace {

std::string complaint(const std::function<void()>& action) {
    try {
        action();
    } catch (const UserError& e) {
        return e.what();
    }
    return "nothing";
}

}  // namespace

TEST(NamedParameters, EveryNumberOfASceneCanBeReadAndSetByItsPath) {
    SceneSpec scene;
    EXPECT_NE(complaint([&] { get_named(scene, "wall.friction"); }).find("does not say wall.friction"),
              std::string::npos);
    scene.wall.friction = 0.1;
    int count = 0;
    for (const NamedParameter& named : named_parameters()) {
        const double before = get_named(scene, named.path);
        EXPECT_GE(before, named.minimum) << named.path;
        EXPECT_LE(before, named.maximum) << named.path;
        set_named(scene, named.path, before);
        EXPECT_EQ(get_named(scene, named.path), before) << named.path;
        ++count;
    }
    EXPECT_GT(count, 20);
}

TEST(NamedParameters, ReachTheSceneAndSwitchAnEffectOn) {
    SceneSpec scene;
    set_named(scene, "wall.cluster_stiffness", 0.65);
    EXPECT_EQ(scene.wall.cluster_stiffness, 0.65);
    set_named(scene, "effects.respiration.period_s", 5.5);
    EXPECT_EQ(get_named(scene, "effects.respiration.period_s"), 5.5);
    for (const SceneEffect& effect : scene.effects) EXPECT_EQ(effect.enabled, effect.info->name == "respiration");
}

TEST(NamedParameters, NameTheNearestPathAndTheRange) {
    SceneSpec scene;
    EXPECT_NE(complaint([&] { set_named(scene, "wall.cluster_stifness", 0.5); }).find("'wall.cluster_stiffness'"),
              std::string::npos);
    EXPECT_NE(complaint([&] { set_named(scene, "wall.cluster_stiffness", 1.5); }).find("allowed: 0"),
              std::string::npos);
    EXPECT_NE(complaint([] { named_bound("wall.cluster_stiffness", 0.9, 0.1); }).find("turned round"),
              std::string::npos);
    EXPECT_NE(complaint([] { named_bound("wall.cluster_stiffness", -3.0, 0.5); }).find("leaves"), std::string::npos);
    EXPECT_EQ(named_bound("wall.cluster_stiffness", 0.2, 0.9).name, "wall.cluster_stiffness");
}

TEST(NamedParameters, AnOverlayIsTomlThatSaysThem) {
    const std::vector<std::string> paths{"wall.cluster_stiffness", "effects.respiration.period_s",
                                         "wall.cluster_radius_mm"};
    const std::vector<double> values{0.75, 4.0, 12.5};
    const std::string text = overlay_text(paths, values);
    EXPECT_EQ(text,
              "[wall]\ncluster_stiffness = 0.75\ncluster_radius_mm = 12.5\n\n"
              "[effects.respiration]\nenabled = true\nperiod_s = 4.0\n");
    const TomlNode toml = parse_toml(text, "overlay");
    ASSERT_NE(toml.find("wall"), nullptr);
    EXPECT_EQ(toml.find("wall")->find("cluster_radius_mm")->number, 12.5);
}
