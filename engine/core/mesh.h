// A triangle mesh as plain arrays.
#pragma once

#include <vector>

#include "core/types.h"

namespace cathlab {

struct TriMesh {
    std::vector<Vec3> vertices;       ///< (n) mm
    std::vector<Triangle> triangles;  ///< (m) counter-clockwise seen from outside

    bool empty() const { return triangles.empty(); }
};

/// The faults that make a surface useless as a lumen.
struct MeshFaults {
    std::size_t open_edges = 0;          ///< edges with one triangle
    std::size_t non_manifold_edges = 0;  ///< edges with more than two, or two that run the same way
    std::size_t degenerate_triangles = 0;
    Vec3 first_place = Vec3::Zero();  ///< middle of the first faulty edge
    bool sound() const { return open_edges + non_manifold_edges == 0; }
};
MeshFaults find_faults(const TriMesh& mesh);

/// Signed volume in mm3 (positive when triangles face outward) and area in mm2.
double signed_volume(const TriMesh& mesh);
double surface_area(const TriMesh& mesh);

/// Area-weighted unit normals, one a vertex; zero where a vertex has no triangle.
std::vector<Vec3> vertex_normals(const TriMesh& mesh);

}  // namespace cathlab
