// [wall] of a scene as the soft body takes it.
#pragma once

#include "scene/scene_spec.h"
#include "softbody/model.h"

namespace cathlab {

/// The particles' wall parameters that a scene's [wall] stands for; its regions, which an anatomy names, are left out.
WallParameters wall_parameters(const SceneWall& wall);

}  // namespace cathlab
