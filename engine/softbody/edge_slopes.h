// Second derivatives of position on a triangle of a wall, by the particles around it.
//
// They are those of Gauss: of the slopes across the triangle's edges, as in triangles without rotations [onate1993].
// An edge has one slope for both of its triangles, so that a moment which is the same everywhere pulls at no particle
// within the wall; and the slope is that of every quadratic, by the particles of the two triangles and of the four
// beside them.  With either alone a wall is too soft by as much as its triangles are irregular, however small they are.
#pragma once

#include <span>
#include <vector>

#include "core/types.h"

namespace cathlab {

/// Columns (of positions) and entries (of weights): 11, 22, 12, in the triangle's frame at rest, whose first axis is
/// its first edge and whose second points to its third corner.
struct SecondDerivatives {
    std::vector<Index> particle;  ///< the triangle's corners first
    std::vector<Vec3> weight;     ///< one a particle, 1/mm2
    Mat3 held = Mat3::Zero();     ///< what edges that keep their slope add, 1/mm
};

/// rest: (n) mm.  triangles: outward, with an area, no edge shared by more than two, no two on the same corners
/// (CATHLAB_CHECK).  held: one a particle or empty; an open edge between two that are marked keeps its slope.  One a
/// triangle.
std::vector<SecondDerivatives> second_derivatives(std::span<const Vec3> rest, std::span<const Triangle> triangles,
                                                  std::span<const std::uint8_t> held);

}  // namespace cathlab
