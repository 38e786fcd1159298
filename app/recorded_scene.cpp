#include "recorded_scene.h"

#include <filesystem>

#include "core/errors.h"
#include "core/log.h"
#include "scene/load_scene.h"

namespace cathlab {

SceneSpec recorded_scene(const RunRecord& run, const AppContext& context) {
    std::vector<std::string> overlays;
    for (const std::string& overlay : run.manifest.overlays) {
        const std::string inside = run.folder + "/" + overlay;  // what a trainer's session was set up with
        const bool own = std::filesystem::path(overlay).is_relative() && std::filesystem::is_regular_file(inside);
        overlays.push_back(own ? inside : find_scene(overlay, context.data_root));
    }
    SceneSpec scene = load_scene(find_scene(run.manifest.scene, context.data_root), overlays, context.data_root);
    const std::string versions = "recorded by version " + run.manifest.version + ", this is " CATHLAB_VERSION;
    const bool same_version = run.manifest.version == CATHLAB_VERSION;
    if (scene.hash != run.manifest.scene_hash)
        throw UserError(run.folder + ": the scene " + scene.path +
                        ", its overlays or the files that it names have changed since this run was recorded" +
                        (same_version ? "" : " (" + versions + ")"));
    if (!same_version) log::warn(versions);
    return scene;
}

}  // namespace cathlab
