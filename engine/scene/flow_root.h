// Where the heart's blood enters the vessels: [contrast] root of a scene, looked up in its anatomy.
#pragma once

#include "anatomy/model.h"
#include "scene/scene_spec.h"

namespace cathlab {

/// The node of the centre-line graph from which the blood flows.  `wanted.root` is
///   "auto"       the annulus; where there is none, the free end of the widest vessel (median radius to its first
///                branch)
///   "annulus"    of an anatomy that has one
///   a landmark   that stands at a free end (an imported mesh has "end_1", "end_2", ...)
///   an entry     the free end behind its sheath
///   a point      (mm, world): the free end nearest to it
/// Throws UserError for any other name, with the names of the ends.
Index flow_root(const AnatomyModel& anatomy, const SceneContrast& wanted);

}  // namespace cathlab
