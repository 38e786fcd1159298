// A wire out of a guiding catheter, whose mouth is part of no archive: the wall says where it is.
#include <gtest/gtest.h>

#include "scene/build_world.h"
#include "scene/load_scene.h"
#include "step/parts.h"
#include "step/step.h"

namespace cathlab {
namespace {

TEST(GuidedWire, TheMouthOfItsGuideGoesAlongWithTheBeatingOstium) {
    const std::string root = CATHLAB_SOURCE_DIR;
    BuildOptions options;
    options.cache_folder = testing::TempDir() + "cathlab_cache";
    const auto world = build_world(load_scene(root + "/scenes/tasks/e.toml", {}, root), options);
    Channels channels;
    Vec3 low = Vec3::Constant(1e9), high = -low;
    double worst = 0.0;
    for (int k = 0; k < 60; ++k) {
        step(*world, Input{}, channels);
        const Parts parts = find_parts(*world);
        const Vec3 mouth = parts.wire->sheath().mouth.position;
        low = low.cwiseMin(mouth);
        high = high.cwiseMax(mouth);
        // What the sheath holds stands behind the mouth; the particles have moved on by one substep since.
        const Pose held = parts.wire->link_pose(parts.wire->free_link_count());
        const Vec3 from = held.position - mouth;
        const Vec3 axis = parts.wire->sheath().mouth.orientation * Vec3::UnitZ();
        worst = std::max(worst, (from - axis * axis.dot(from)).norm());
        EXPECT_LT(axis.dot(from), 0.0);
    }
    EXPECT_GT((high - low).norm(), 3.0) << "mm in a beat and a half";
    EXPECT_LT(worst, 1e-9);
}

}  // namespace
}  // namespace cathlab
