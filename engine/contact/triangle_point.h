// Closest point of one triangle, with the feature that it lies on.
#pragma once

#include "core/types.h"

namespace cathlab {

struct TrianglePoint {
    Vec3 barycentric = Vec3::Zero();
    Vec3 point = Vec3::Zero();
    double squared_distance = 0.0;  ///< mm2
    int feature = 6;                ///< 0..2 corner k, 3..5 edge from corner k to k + 1, 6 the inside
};

/// By the Voronoi regions of corners, edges and face [ericson2005], section 5.1.5.  A triangle without area counts as
/// its three edges; an edge without length as its corner.
TrianglePoint closest_on_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c);

}  // namespace cathlab
