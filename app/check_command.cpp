// cathlab check: whether a scene and everything that it names can be used.
#include <CLI/CLI.hpp>
#include <cstdio>

#include "commands.h"
#include "core/hash.h"
#include "scene/anatomy_file.h"
#include "scene/device_file.h"
#include "scene/load_scene.h"
#include "scene/script.h"
#include "session.h"

namespace cathlab {
namespace {

struct CheckOptions {
    std::string scene;
    std::vector<std::string> overlays;
    bool build = false;
};

void check(const CheckOptions& options, const AppContext& context) {
    const SceneSpec scene =
        load_scene(find_scene(options.scene, context.data_root), options.overlays, context.data_root);
    if (!scene.anatomy.file.empty()) load_anatomy(scene.anatomy.file);
    if (!scene.wire.device.empty()) load_wire(scene.wire.device);
    if (!scene.catheter.device.empty()) {
        if (device_kind(scene.catheter.device) == "passive_catheter")
            load_sleeve(scene.catheter.device);
        else
            load_catheter(scene.catheter.device);
    }
    if (!scene.script.empty()) Script::load(scene.script);
    // The faults of a mesh show only when it is read, and it is read in seconds.
    if (options.build || !scene.anatomy.imported.mesh.empty())
        const Session session(scene, scene.seed, default_threads(), context);
    std::printf("%s: the scene '%s' can be used; content hash %s\n", scene.path.c_str(), scene.name.c_str(),
                hash_text(scene.hash).c_str());
}

}  // namespace

void add_check_command(CLI::App& app, AppContext& context) {
    const auto options = std::make_shared<CheckOptions>();
    CLI::App* command = app.add_subcommand("check", "Check a scene and the files that it names");
    command->add_option("SCENE", options->scene, "a scene file, or the name of one in scenes/")->required();
    command->add_option("--overlay", options->overlays, "a file laid over the scene; may be given again")
        ->allow_extra_args(false);
    command->add_flag("--build", options->build, "build its world too");
    command->callback([options, &context] { check(*options, context); });
}

}  // namespace cathlab
