// Remeshing of a closed surface to wanted edge lengths: split, collapse, flip, tangential relaxation, projection
// (after Botsch and Kobbelt 2004 [botsch2004], with a size that varies from place to place).
#pragma once

#include <functional>

#include "core/mesh.h"
#include "core/parallel.h"

namespace cathlab {

struct RemeshGoal {
    std::function<double(const Vec3&)> size;                   ///< wanted edge length at a place, mm
    std::function<Vec3(const Vec3&, double edge_mm)> project;  ///< back onto the surface (may be empty)
    int rounds = 5;
};

/// Keeps the surface closed and manifold and its genus; throws nothing for a sound mesh.
TriMesh remesh(const TriMesh& mesh, const RemeshGoal& goal, const Workers& workers);

/// Taubin's smoothing [taubin1995]: `steps` times lambda, then mu, with uniform weights.
void taubin_smooth(TriMesh& mesh, int steps, double lambda, double mu);

/// Quadric edge collapse by meshoptimizer to about `triangles`, or until the error is that share of the mesh's size;
/// gives the mesh back unchanged where the result would not be sound.
TriMesh decimate(const TriMesh& mesh, std::size_t triangles, double error = 0.01);

/// Every triangle cut into four (edges' midpoints).
TriMesh subdivide(const TriMesh& mesh);

/// The connected part with the most triangles.
TriMesh largest_part(const TriMesh& mesh);

struct MeshQuality {
    double smallest_angle_deg = 180.0;
    double share_below_15_deg = 0.0;
    int genus = 0;  ///< summed over the components, from Euler's number
    int components = 0;
};
MeshQuality measure_quality(const TriMesh& mesh);

}  // namespace cathlab
