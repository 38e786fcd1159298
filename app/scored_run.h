// A recorded run once more from its inputs alone: what it comes to, and what is stored otherwise.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "context.h"
#include "record/run_reader.h"
#include "scene/build_world.h"
#include "scene/scene_spec.h"
#include "task/metrics.h"
#include "task/task.h"
#include "world/world.h"

namespace cathlab {

struct ScoredRun {
    std::string folder;
    Metrics metrics;
    std::optional<TaskSpec> task;
    bool reached = false;
    double score = 0.0;
    std::vector<std::string> differences;  ///< from what is stored; a sentence each
};

/// Steps the recorded inputs without a picture and compares each file's sum, every channel, the hashes of the state,
/// the events, the result of the task and each stored metric, bit by bit.  scene: as recorded_scene gives it.  models:
/// null = built here.  progress: the fraction done, called now and then; each: after every step of this index.  Both
/// may be empty.  Throws UserError where the run cannot be read, its anatomy is built otherwise now, or a stop was
/// wanted.
ScoredRun score_run(const RunRecord& run, const SceneSpec& scene, const SceneModels* models, int threads,
                    const AppContext& context, const std::function<void(double)>& progress,
                    const std::function<void(std::int64_t, World&)>& each = {});

}  // namespace cathlab
