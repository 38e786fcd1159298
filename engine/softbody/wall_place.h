// A place that goes along with the wall round it: a goal, the mouth of a guiding catheter.
#pragma once

#include <span>
#include <vector>

#include "softbody/model.h"

namespace cathlab {

struct WallPlace {
    Pose rest;                     ///< world, where the wall is at rest
    std::vector<Index> particles;  ///< those nearest to it
};

WallPlace wall_place(const SoftBodyModel& wall, const Pose& rest);

/// At rest, moved by the mean displacement of its particles; it does not turn.  x: positions of the particles, mm.
Pose place_now(const WallPlace& place, const SoftBodyModel& wall, std::span<const Vec3> x);

}  // namespace cathlab
