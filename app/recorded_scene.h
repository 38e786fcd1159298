// The scene of a recorded run, as it was.
#pragma once

#include "context.h"
#include "record/run_reader.h"
#include "scene/scene_spec.h"

namespace cathlab {

/// Throws UserError where the scene, its overlays or the files that it names have changed since.
SceneSpec recorded_scene(const RunRecord& run, const AppContext& context);

}  // namespace cathlab
