// A stiff wire that is pushed on in the aorta keeps its length.  CATHLAB_STRETCH_SECONDS pushes it for longer: after 15
// s the drive slips, at 5 N.
#include <cstdio>
#include <cstdlib>
#include <filesystem>

#include "scene/temporary_folder.h"
#include "step/rig.h"

namespace cathlab {
namespace {

TEST(Stretch, OfAStiffWirePushedOnInTheAdultsAortaIsUnderAFiftiethOfAPercent) {
    const TemporaryFolder folder;
    const SceneSpec spec = load_scene(folder.write("pushed.toml", R"(
schema = 1
name = "pushed"
[anatomy]
file = "adult"
[wire]
enabled = true
device = "amplatz-super-stiff"
entry = "right_femoral"
insertion_mm = 760
)"),
                                      {}, CATHLAB_SOURCE_DIR);
    BuildOptions options;
    const auto program = std::filesystem::read_symlink("/proc/self/exe");
    options.cache_folder = (program.parent_path() / "models").string();
    RigRun run(build_world(spec, *build_models(spec, options), 1, 1));
    run.step({}, 50);  // laid along the middle of the vessels it finds its own way first
    double most = 0.0, push_mn = 0.0;
    const char* longer = std::getenv("CATHLAB_STRETCH_SECONDS");
    const int steps = longer ? static_cast<int>(50.0 * std::atof(longer)) : 250;
    for (int k = 0; k < steps; ++k) {
        run.step(push(100.0));
        most = std::max(most, run.channels.wire_stretch_max);
        push_mn = std::max(push_mn, run.channels.wire_sheath_force_mn);
    }
    std::printf("pushed by up to %.0f mN: largest stretch %.4f %%\n", push_mn, 100.0 * most);
    EXPECT_GT(push_mn, 1000.0);
    EXPECT_LT(most, 2e-4);
}

}  // namespace
}  // namespace cathlab
