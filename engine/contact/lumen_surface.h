// The surface that devices touch: the lumen, skinned to the wall's particles, with a tree of boxes that follows it.
#pragma once

#include <span>
#include <vector>

#include "contact/surface_tree.h"
#include "core/mesh.h"
#include "core/parallel.h"
#include "core/types.h"
#include "softbody/binding.h"

namespace cathlab {

/// Const after build; shared by all worlds of a process.
struct LumenSurfaceModel {
    std::vector<Triangle> triangles;     ///< (m) counter-clockwise seen from outside the lumen
    std::vector<Index> triangle_region;  ///< (m) region of most of its corners
    std::vector<Triangle> across;        ///< (m) triangle behind the edge from corner k to corner k + 1; -1 = open edge
    std::vector<Index> fan_start, fan;   ///< triangles at vertex v: fan[fan_start[v] .. fan_start[v + 1]), ascending
    std::vector<Index> vertex_region;    ///< (n)
    std::vector<double> vertex_radius;   ///< (n) radius of the lumen nearby, mm
    Index region_count = 0;              ///< highest region + 1
    PointBinding binding;                ///< vertex = affine weights over the wall's particles
    Index particle_count = 0;            ///< highest particle of the binding + 1
    SurfaceTree tree;

    std::size_t vertex_count() const { return vertex_region.size(); }
};

/// Follows from the particles alone, so it is not part of a state hash.
struct LumenSurfaceState {
    std::vector<Vec3> vertices;  ///< (n) mm, world, now
    TreeBoxes boxes;             ///< of the tree
};

/// Builds adjacency and tree on the surface at rest.  vertex_region and vertex_radius hold one entry a vertex (or none:
/// region 0, radius 0); `binding` holds one point a vertex.  Open or non-manifold surfaces are accepted, but the side
/// of a point is then only known near sound parts; whoever loads a mesh refuses those (find_faults).  Throws
/// std::logic_error on sizes that do not agree and on indices out of range.
LumenSurfaceModel build_lumen_surface(const TriMesh& lumen, std::span<const Index> vertex_region,
                                      std::span<const double> vertex_radius, PointBinding binding);

/// Skins the vertices to the particles (mm, world) and refits the boxes.  The tree is never rebuilt.
void update(const LumenSurfaceModel& model, std::span<const Vec3> particle_positions, LumenSurfaceState& state,
            const Workers& workers);

/// The same for a part of it; the rest stays where it was.  What devices do not come near needs to follow a step and
/// not a substep.
void update(const LumenSurfaceModel& model, std::span<const Vec3> particle_positions, const TreePart& part,
            LumenSurfaceState& state, const Workers& workers);

/// Unit normals into the lumen; zero where the triangle has no area.
Vec3 inward_triangle_normal(const LumenSurfaceModel& model, const LumenSurfaceState& state, Index triangle);

/// Angle-weighted pseudo-normals into the lumen, unit (zero where all triangles around are degenerate): for an edge the
/// sum of its two triangles' normals, for a vertex the sum weighted by the angle of each triangle there.  The sign of
/// pseudo-normal . (p - closest point) tells the side of p exactly [baerentzen2005].  They are computed on demand: a
/// query needs one, an update would have to make thirty thousand.
Vec3 inward_edge_normal(const LumenSurfaceModel& model, const LumenSurfaceState& state, Index triangle, int edge);
Vec3 inward_vertex_normal(const LumenSurfaceModel& model, const LumenSurfaceState& state, Index vertex);

/// The normal into the lumen that a smooth wall would have at a point of a triangle: area-weighted normals of the three
/// corners, interpolated; unit, zero where all is degenerate.
Vec3 inward_smooth_normal(const LumenSurfaceModel& model, const LumenSurfaceState& state, Index triangle,
                          const Vec3& barycentric);

/// Radius of the lumen at a point of a triangle, mm (of the anatomy at rest).
double lumen_radius(const LumenSurfaceModel& model, Index triangle, const Vec3& barycentric);

}  // namespace cathlab
