// Where a device comes in: an entry site, or a guiding catheter engaged at a landmark.
#include "scene/entry.h"

#include <gtest/gtest.h>

#include "core/errors.h"
#include "scene/build_world.h"
#include "scene/load_scene.h"
#include "world/step_settings.h"

namespace cathlab {
namespace {

const std::string root = CATHLAB_SOURCE_DIR;

SceneSpec scene_e() {
    return load_scene(root + "/scenes/tasks/e.toml", {}, root);
}

BuildOptions cached() {
    BuildOptions options;
    options.cache_folder = testing::TempDir() + "cathlab_cache";
    return options;
}

TEST(WayIn, AGuidedWireLooksDownTheVesselThatItIsEngagedIn) {
    const auto world = build_world(scene_e(), cached());
    const AnatomyModel& anatomy = **world->first<Shared<AnatomyModel>>();
    SceneDevice device = scene_e().wire;
    const WayIn way = find_way_in(anatomy, device, true);
    ASSERT_TRUE(way.guided());
    const auto region_of = [&](const Vec3& p) {
        const CentrelineGraph& graph = anatomy.centreline;
        return anatomy.regions[static_cast<std::size_t>(graph.nodes[static_cast<std::size_t>(graph.nearest(p))].region)]
            .name;
    };
    EXPECT_EQ(region_of(way.points.back()), "right_coronary");
    EXPECT_EQ(region_of(way.guide.back()), "right_femoral");
    EXPECT_EQ(region_of(way.guide[way.guide.size() / 2]), "descending_aorta");
    // The mouth stands some millimetres inside, and the way goes on from it without a corner.
    const Vec3 inward = way.entry.pose.orientation * Vec3::UnitZ();
    EXPECT_EQ(way.points.front(), way.entry.pose.position);
    EXPECT_GT(inward.dot((way.points[1] - way.points[0]).normalized()), 0.9);
}

TEST(WayIn, ANameThatThereIsNotNamesEntriesAndLandmarks) {
    const auto world = build_world(scene_e(), cached());
    const AnatomyModel& anatomy = **world->first<Shared<AnatomyModel>>();
    SceneDevice device = scene_e().wire;
    device.entry = "left_coronary_ostum";
    const auto text = [&](bool may_guide) {
        try {
            find_way_in(anatomy, device, may_guide);
        } catch (const UserError& error) {
            return std::string(error.what());
        }
        return std::string();
    };
    EXPECT_NE(text(true).find("did you mean 'left_coronary_ostium'?"), std::string::npos) << text(true);
    EXPECT_NE(text(true).find("right_femoral"), std::string::npos) << text(true);
    EXPECT_EQ(text(false).find("landmark"), std::string::npos) << text(false);
    device.entry = "left_coronary_ostium";
    EXPECT_FALSE(text(false).empty()) << "a catheter is not guided by another";
}

TEST(WayIn, AGuidedWireAllowsNoOtherCatheter) {
    SceneSpec scene = scene_e();
    scene.catheter.enabled = true;
    scene.catheter.device = root + "/assets/devices/magellan-6f.toml";
    EXPECT_THROW(build_world(scene, cached()), UserError);
}

}  // namespace
}  // namespace cathlab
