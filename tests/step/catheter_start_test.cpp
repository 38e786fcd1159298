// Where a catheter stands that a scene starts deep in the vessels.
#include <filesystem>

#include "scene/temporary_folder.h"
#include "step/inside_account.h"
#include "step/rig.h"

namespace cathlab {
namespace {

SceneSpec deep(const TemporaryFolder& folder) {
    return load_scene(folder.write("deep.toml", R"(
schema = 1
name = "deep"
[anatomy]
file = "adult"
[catheter]
enabled = true
device = "magellan-6f"
entry = "right_femoral"
)"),
                      {}, CATHLAB_SOURCE_DIR);
}

std::shared_ptr<const SceneModels> models_of(const SceneSpec& spec) {
    BuildOptions options;
    const auto program = std::filesystem::read_symlink("/proc/self/exe");
    options.cache_folder = (program.parent_path() / "models").string();
    return build_models(spec, options);
}

TEST(CatheterStart, InTheArchItLiesAlongTheVesselAndStaysInside) {
    const TemporaryFolder folder;
    SceneSpec spec = deep(folder);
    const auto models = models_of(spec);
    for (const double insertion : {640.0, 690.0, 730.0}) {
        spec.catheter.insertion_mm = insertion;
        RigRun run(build_world(spec, *models, 1, 1));
        EXPECT_EQ(run.parts.catheter_state->insertion_mm, insertion);
        LumenSurfaceState surface;
        for (int k = 0; k < 5; ++k) {
            const InsideAccount account = inside_account(run.parts, surface);
            EXPECT_LT(account.deepest_mm, 0.3) << insertion << " after " << 10 * k;
            EXPECT_EQ(account.outside, 0);
            run.step({}, 10);
        }
    }
}

TEST(CatheterStart, WhereItCannotBendAsTheVesselDoesItStartsLessFarInAndSaysSo) {
    const TemporaryFolder folder;
    SceneSpec spec = deep(folder);
    spec.catheter.device = folder.write("stiff.toml", R"(
schema = 1
kind = "catheter"
name = "stiff"
tip_length_mm = 60.0
[[segments]]
name = "only"
length_mm = 5.0
max_bend_deg = 1.0
max_rate_deg_s = 10.0
)");
    spec.catheter.insertion_mm = 690.0;
    RigRun run(build_world(spec, *models_of(spec), 1, 1));
    LumenSurfaceState surface;
    EXPECT_LT(inside_account(run.parts, surface).deepest_mm, 0.35);
    run.step({});
    EXPECT_LT(run.channels.catheter_insertion_mm, 680.0);
    EXPECT_GE(run.count_events("clamped"), 1);
}

}  // namespace
}  // namespace cathlab
