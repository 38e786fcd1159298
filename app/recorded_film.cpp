#include "recorded_film.h"

#include <algorithm>

#include "core/errors.h"
#include "progress.h"
#include "scene/build_world.h"

namespace cathlab {
namespace {

std::shared_ptr<const AnatomyModel> recorded_anatomy(const RunRecord& run, const SceneSpec& scene, int threads,
                                                     const AppContext& context) {
    catch_stop_signals();
    Progress progress("building");
    BuildOptions options;
    options.threads = threads;
    options.cache_folder = context.cache_folder;
    options.progress = [&](double fraction, std::string_view what) {
        if (stop_wanted()) throw UserError("stopped while the anatomy was being built; nothing was written");
        progress.update(fraction, what);
    };
    auto anatomy = build_anatomy(scene, options);
    if (anatomy->content_hash != run.manifest.anatomy_hash)
        throw UserError(run.folder + ": the anatomy is built otherwise than when this run was recorded");
    return anatomy;
}

}  // namespace

RecordedFilm::RecordedFilm(const RunRecord& run, const SceneSpec& scene, int threads, const AppContext& context)
    : anatomy_(recorded_anatomy(run, scene, threads, context)),
      beam_(beam_spec(scene, *anatomy_)),
      workers_(threads),
      trace_(read_trace(run.folder, run.manifest.complete)),
      events_(read_events(run.folder, run.manifest.complete)),
      poses_(run.folder, poses_frame(*anatomy_), run.manifest.complete) {
    if (run.manifest.complete && steps() != run.steps)
        throw UserError(run.folder + "/trace.csv: has " + std::to_string(steps()) + " steps, the run " +
                        std::to_string(run.steps) + " (truncated or edited?)");
}

std::int64_t RecordedFilm::steps() const {
    return static_cast<std::int64_t>(trace_.size());
}

std::int64_t RecordedFilm::film(Film& film, std::int64_t end) {
    const FrameStage stage{anatomy_.get(), &beam_, &workers_};
    end = std::min(end, steps());
    Progress progress("drawing");
    auto event = events_.begin();
    std::int64_t k = 0;
    for (; k < end && !stop_wanted(); ++k) {
        const Channels& channels = trace_[static_cast<std::size_t>(k)];
        for (; event != events_.end() && event->step <= k; ++event) film.message(*event);
        while (film.due(channels.time_s)) film.add(stage, poses_.at(k), channels);
        progress.update(static_cast<double>(k + 1) / static_cast<double>(end));
    }
    progress.end();
    return k;
}

}  // namespace cathlab
