// Runs by an autopilot without pictures, and where a study's trials stand.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "context.h"
#include "scene/build_world.h"
#include "scene/scene_spec.h"
#include "study/protocol.h"

namespace cathlab {

struct PilotedRun {
    std::string folder;                             ///< of the run; what stands there is a whole run
    std::string skill;                              ///< of the autopilot
    std::uint64_t seed = 0;                         ///< of the world and of its hand
    std::string trial = {};                         ///< text of trial.json, "" = none
    std::function<bool(double time_s)> go_on = {};  ///< called once a step; false = stop
};

/// Steps the task's world on one thread until the task ends and writes the whole run folder.  It is made under a name
/// of its own and renamed when it is whole; overlays of the scene are copied into it.  Returns false where it was
/// stopped; then nothing stays.  Throws UserError.
bool fly(const PilotedRun& run, const SceneSpec& scene, const SceneModels& models, const AppContext& context);

/// The scene of a study's task.
std::string task_scene(const std::string& task, const AppContext& context);
/// Whether the trial's run folder stands there.
bool trial_done(const std::string& study, const Trial& trial);
/// The same for the same study, participant, task and trial, whatever else is run.
std::uint64_t trial_seed(const Protocol& protocol, const Trial& trial);

}  // namespace cathlab
