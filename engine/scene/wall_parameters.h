// [wall] of a scene as the soft body takes it.
#pragma once

#include <vector>

#include "anatomy/model.h"
#include "scene/scene_spec.h"
#include "softbody/model.h"

namespace cathlab {

/// The particles' wall parameters that a scene's [wall] stands for; its regions, which an anatomy names, are left out.
WallParameters wall_parameters(const SceneWall& wall);

/// What a scene's [wall] and its [[wall.region]] say of an anatomy's regions: writes spacing, thickness and force limit
/// to them (the scene's spacing is the aorta's; a region that asks for less keeps asking for less) and returns what
/// goes to the soft body.  Throws UserError for a region that the anatomy has not.
std::vector<RegionWall> apply_wall(const SceneWall& wall, std::vector<Region>& regions);

}  // namespace cathlab
