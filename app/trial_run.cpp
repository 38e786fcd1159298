#include "trial_run.h"

#include <chrono>
#include <cmath>
#include <filesystem>

#include "autopilot/autopilot.h"
#include "core/errors.h"
#include "record/run_writer.h"
#include "record/sums.h"
#include "run_facts.h"
#include "session.h"
#include "task_watch.h"

namespace cathlab {
namespace fs = std::filesystem;

bool run_trial(const std::string& study, const Trial& trial, const SceneSpec& scene, const SceneModels& models,
               std::uint64_t seed, const AppContext& context) {
    using Clock = std::chrono::steady_clock;
    const auto begin = Clock::now();
    const std::string folder = study + "/" + trial.folder, part = folder + ".part";
    fs::remove_all(part);  // of a rehearsal that was killed
    prepare_run_folder(part, false);
    Session session(scene, models, seed, 1);
    const auto task = task_of(scene);
    if (!task) throw UserError(scene.path + ": sets no [task]");
    Autopilot pilot(session.world(), scene, *task, find_skill(trial.group), seed);
    TaskWatch watch(session.world(), task);
    RunManifest manifest = manifest_of(scene, {}, session.anatomy_hash(), context);
    manifest.seed = seed;
    RunWriter writer(part, manifest, session.entity_names());
    const Input base = session.base_input();
    std::int64_t step = 0;
    for (; !watch.over() && !stop_wanted(); ++step) {
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
    writer.file("result.json", watch.result_json({"autopilot", trial.group}));
    writer.file("trial.json", trial_json(trial));
    writer.finish(step, true, std::chrono::duration<double>(Clock::now() - begin).count(), "");
    write_sums(part);
    fs::rename(part, folder);
    return true;
}

}  // namespace cathlab
