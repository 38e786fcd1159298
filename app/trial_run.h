// One trial of a study by an autopilot: a run folder without pictures.
#pragma once

#include <string>

#include "context.h"
#include "scene/build_world.h"
#include "scene/scene_spec.h"
#include "study/protocol.h"

namespace cathlab {

/// Steps the task's world on one thread until the task ends and writes the whole run folder, trial.json among it.
/// The folder is made under a name of its own and renamed when it is whole: what stands there is a whole trial. Returns
/// false where it was stopped; then nothing stays.  Throws UserError.
bool run_trial(const std::string& study, const Trial& trial, const SceneSpec& scene, const SceneModels& models,
               std::uint64_t seed, const AppContext& context);

}  // namespace cathlab
