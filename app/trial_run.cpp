#include "trial_run.h"

#include <chrono>
#include <cmath>
#include <filesystem>

#include "autopilot/autopilot.h"
#include "core/errors.h"
#include "core/hash.h"
#include "record/run_writer.h"
#include "record/sums.h"
#include "run_facts.h"
#include "session.h"
#include "task_watch.h"

namespace cathlab {
namespace fs = std::filesystem;
namespace {

// The folder alone must suffice for a replay.
void keep_overlays(const std::string& folder, const SceneSpec& scene, RunManifest& manifest) {
    for (std::size_t i = 0; i < scene.overlays.size(); ++i) {
        const fs::path overlay(scene.overlays[i]);
        const std::string name = "overlay-" + std::to_string(i + 1) + ".toml";
        std::error_code error;
        fs::copy_file(overlay, fs::path(folder) / name, error);
        if (error) throw UserError(overlay.string() + ": cannot be copied: " + error.message());
        manifest.overlays[i] = name;
    }
}

}  // namespace

bool fly(const PilotedRun& run, const SceneSpec& scene, const SceneModels& models, const AppContext& context) {
    using Clock = std::chrono::steady_clock;
    const auto begin = Clock::now();
    const std::string part = run.folder + ".part";
    fs::remove_all(part);  // of one that was killed
    prepare_run_folder(part, false);
    Session session(scene, models, run.seed, 1);
    const auto task = task_of(scene);
    if (!task) throw UserError(scene.path + ": sets no [task]");
    Autopilot pilot(session.world(), scene, *task, find_skill(run.skill), run.seed);
    TaskWatch watch(session.world(), task);
    RunManifest manifest = manifest_of(scene, scene.overlays, session.anatomy_hash(), context);
    manifest.seed = run.seed;
    keep_overlays(part, scene, manifest);
    RunWriter writer(part, manifest, session.entity_names());
    const Input base = session.base_input();
    std::int64_t step = 0;
    const auto goes_on = [&] { return !stop_wanted() && (!run.go_on || run.go_on(session.channels().time_s)); };
    for (; !watch.over() && goes_on(); ++step) {
        if (RunWriter::wants_hash(step)) writer.hash(step, session.world().state_hash());
        const Input input = pilot.act(session.world(), session.channels(), base);
        writer.input(step, input);
        session.step(input);
        writer.step(step, session.channels(), session.events());
        watch.add(session.world(), session.channels(), session.dt());
    }
    if (!watch.over()) {
        fs::remove_all(part);
        return false;
    }
    writer.hash(step, session.world().state_hash());
    writer.file("metrics.json", metrics_json(watch.metrics()));
    writer.file("regions.csv", watch.forces().regions_csv());
    writer.file("force-map.csv", force_map_csv(watch.forces().unrolled()));
    writer.file("result.json", watch.result_json({"autopilot", run.skill}));
    if (!run.trial.empty()) writer.file("trial.json", run.trial);
    writer.finish(step, true, std::chrono::duration<double>(Clock::now() - begin).count(), "");
    write_sums(part);
    fs::rename(part, run.folder);
    return true;
}

std::string task_scene(const std::string& task, const AppContext& context) {
    return context.data_root + "/scenes/tasks/" + task + ".toml";
}

bool trial_done(const std::string& study, const Trial& trial) {
    return fs::exists(study + "/" + trial.folder + "/manifest.json");
}

std::uint64_t trial_seed(const Protocol& protocol, const Trial& trial) {
    Hash64 hash;
    for (const std::string& text : {protocol.name, trial.participant, trial.task}) hash.text(text);
    hash.word(static_cast<std::uint64_t>(trial.trial));
    constexpr std::uint64_t most = 9007199254740991;  // what a scene's seed may be
    return hash.value() & most;
}

}  // namespace cathlab
