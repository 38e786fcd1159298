// Where is the wall, and on which side of it are we?
#pragma once

#include <limits>
#include <optional>
#include <vector>

#include "contact/lumen_surface.h"

namespace cathlab {

/// A point of the lumen surface as a device point sees it.
struct SurfacePoint {
    Index triangle = -1;                ///< -1 = nothing within reach
    Vec3 barycentric = Vec3::Zero();    ///< of the triangle's corners, >= 0, sum 1
    Vec3 point = Vec3::Zero();          ///< mm, world
    Vec3 inward_normal = Vec3::Zero();  ///< unit, into the lumen; zero only where the surface around is degenerate
    double signed_distance = 0.0;       ///< mm, positive inside the lumen

    bool found() const { return triangle >= 0; }
};

/// Closest point of the surface within max_distance (mm) of p, exact, with its side by the pseudo-normal of the feature
/// (face, edge, vertex) that it lies on [baerentzen2005].  inward_normal = +-(p - point)/|p - point|, turned into the
/// lumen; nearer than 1e-6 mm the pseudo-normal itself.  Of equally near triangles the one with the lowest index.
///
/// hint = the triangle found for the same device point before, or -1.  It starts the search, and it decides in which
/// vessel the point is.  Let G be the closest point of all.  Where G lies on a triangle that touches the hint, or that
/// is connected to it through triangles within (distance from p to the hint + 0.5 mm) of p, G is the answer.  Otherwise
/// let L be the closest point of that connected patch: if p is outside by L, it went out through the patch and the wall
/// of a neighbouring vessel, however near, is not its own: the answer is L.  If p is inside by L, it only crossed the
/// lumen: the answer is G. A hint further than 6 mm from p says nothing.
///
/// near: where given, gathered about p within max_distance at least; the tree is not walked again.
///
/// p must be finite (std::logic_error).
SurfacePoint closest(const LumenSurfaceModel& model, const LumenSurfaceState& state, const Vec3& p, double max_distance,
                     Index hint = -1, const NearTriangles* near = nullptr);

/// What is known of the wall at a device's sphere from the last look at it.
struct WallSeen {
    double depth_mm = std::numeric_limits<double>::infinity();  ///< how deep it was in it
    Vec3 pressed_by = Vec3::Zero();  ///< inward normal of what pressed it hardest; zero = nothing did
};

/// The same for a sphere of `radius`.  Where a wall is folded over a device, its patch about the hint, and even the
/// closest point of all, may be a sheet that lies the other way round, and the sphere on its far side without ever
/// having gone through it.  An answer is believed that leaves the centre within the lumen, that is no more than
/// credible_slack_mm deeper than was seen, or that faces as what pressed the sphere did: a wall that is driven through
/// a tip stays its own.  Any other is asked for again without the hint, and is no answer if it is as bad.
SurfacePoint closest_credible(const LumenSurfaceModel& model, const LumenSurfaceState& state, const Vec3& p,
                              double max_distance, Index hint, double radius, const WallSeen& seen,
                              const NearTriangles* near = nullptr);

/// Facets turn under a sphere: it may be found so much deeper (mm) than its rows said; 0.75 were seen.
constexpr double credible_slack_mm = 1.0;

/// The place where the segment from a to b first leaves the lumen (crosses a triangle against its inward normal), if
/// any. signed_distance is that of b to the plane of the triangle.
std::optional<SurfacePoint> first_exit(const LumenSurfaceModel& model, const LumenSurfaceState& state, const Vec3& a,
                                       const Vec3& b);

/// Further walls that a sphere about p meets within `reach` besides `nearest`: in a narrow vessel, in a corner, in the
/// dent that it presses itself.  Up to `at_most` points, their tangent planes nearest to p first (signed_distance and
/// inward_normal are the plane's, with the smooth normal), whose normals differ by more than 25 degrees from
/// nearest_normal and from each other's.  Only walls that close in on p together with the nearest one (each foot point
/// on the inner side of the other's plane): there the lumen lies between the planes, so that a row for each holds a
/// sample from sliding through one wall while another is pushed back, and the curvature of the wall acts within the
/// solve and not one substep late.  A wall beyond a ridge, and a neighbouring vessel's, do not qualify.
std::vector<SurfacePoint> further_walls(const LumenSurfaceModel& model, const LumenSurfaceState& state, const Vec3& p,
                                        double reach, const SurfacePoint& nearest, const Vec3& nearest_normal,
                                        int at_most, const NearTriangles* near = nullptr);

}  // namespace cathlab
