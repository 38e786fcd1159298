// The centre-line of a closed lumen, found from distances to its wall.
//
// On a lattice of points inside, paths of least cost (length / distance to the wall ^ 2) run from the far ends to a
// root and follow the ridge of the distance (after TEASAR [sato2000]).  What the tree leaves open of a loop is closed
// where the parts of two distant branches touch.
#pragma once

#include <array>
#include <vector>

#include "anatomy/curve.h"
#include "anatomy/voxel_surface.h"

namespace cathlab {

struct Skeleton {
    std::vector<Curve> chains;  ///< from one joint to another, smoothed, with the distance to the wall as radius
    std::vector<std::array<Index, 2>> joints;  ///< of each chain: its two ends
    std::vector<int> degree;                   ///< of each joint: chains that end there; 1 = a free end
    int loops = 0;                             ///< chains - joints + 1
};

/// `spacing`: of the lattice, mm.  low, high: the mesh's box.  Empty where no lattice point lies inside.
Skeleton find_skeleton(const DistanceGrid& distance, const Vec3& low, const Vec3& high, double spacing,
                       const Workers& workers);

}  // namespace cathlab
