// The rail of a straight vessel.
#pragma once

#include "catheter/rail.h"

namespace cathlab {

/// Along z from the origin, frames unturned.
inline Rail straight_rail(double length_mm = 300.0) {
    std::vector<Vec3> nodes;
    for (double z = 0.0; z <= length_mm; z += 2.0) nodes.emplace_back(0.0, 0.0, z);
    return build_rail(Pose{}, nodes, {});
}

}  // namespace cathlab
