// Every wire of the assets, operated at random at full speed before a fork.
#include <cstdio>

#include "core/random.h"
#include "scene/device_file.h"
#include "step/rig.h"

namespace cathlab {
namespace {

TEST(PresetOperation, EveryWireStaysInsideTheForkAtFullSpeed) {
    const double seconds =
        std::getenv("CATHLAB_RANDOM_SECONDS") ? std::atof(std::getenv("CATHLAB_RANDOM_SECONDS")) : 2.0;
    const std::string folder = std::string(CATHLAB_SOURCE_DIR) + "/assets/devices/";
    for (const std::string& name : names_in_folder(folder, ".toml")) {
        if (device_kind(folder + name + ".toml") != "wire") continue;
        SceneSpec spec = rig_spec("side_branch");
        spec.wire.device = folder + name + ".toml";
        RigRun run(spec, "side_branch");
        double deepest = 0.0, outside = 0.0, force = 0.0, stretch = 0.0;
        for (int k = 0; k < seconds / 0.02; ++k) {
            const auto draw = [&](std::uint64_t i) {
                return random_uniform(11, RandomStream::test, static_cast<std::uint64_t>(k / 35), i);
            };
            Input input;
            input.advance = draw(0) < 0.65 ? 100.0 : -100.0;
            input.rotate = 720.0 * draw(1) - 360.0;
            run.step(input);
            ASSERT_TRUE(run.finite()) << name << " step " << k;
            deepest = std::max(deepest, run.channels.wire_penetration_mm);
            outside = std::max(outside, run.channels.outside_count);
            force = std::max(force, run.channels.wire_force_mn);
            stretch = std::max(stretch, run.channels.wire_stretch_max);
        }
        std::printf("%-28s deepest %.3f mm, force up to %.0f mN, stretch %.5f\n", name.c_str(), deepest, force,
                    stretch);
        EXPECT_EQ(outside, 0.0) << name;
        EXPECT_LT(deepest, 0.3) << name;
        EXPECT_LT(stretch, 0.15) << name;  // of one link, for a substep, where a shaped tip snaps round
    }
}

}  // namespace
}  // namespace cathlab
