// On which side of a closed surface a point lies, by a road of its own: no closest point, no normal.
#pragma once

#include <cmath>
#include <numbers>
#include <span>

#include "core/mesh.h"

namespace cathlab {

/// Winding number: the sum of the triangles' signed solid angles [oosterom1983] over 4 pi.  1 inside a closed surface
/// whose triangles are counter-clockwise seen from outside, 0 outside; where such a surface overlaps itself, how often
/// it wraps the point.
inline double winding(std::span<const Triangle> triangles, std::span<const Vec3> vertices, const Vec3& p) {
    double sum = 0.0;
    for (const Triangle& t : triangles) {
        const Vec3 a = vertices[static_cast<std::size_t>(t[0])] - p;
        const Vec3 b = vertices[static_cast<std::size_t>(t[1])] - p;
        const Vec3 c = vertices[static_cast<std::size_t>(t[2])] - p;
        const double la = a.norm(), lb = b.norm(), lc = c.norm();
        sum += 2.0 * std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
    }
    return sum / (4.0 * std::numbers::pi);
}
inline double winding(const TriMesh& mesh, const Vec3& p) {
    return winding(mesh.triangles, mesh.vertices, p);
}

}  // namespace cathlab
