// Surfaces of implicit solids and distances to closed meshes, both by OpenVDB.
#pragma once

#include <functional>
#include <memory>

#include "core/mesh.h"
#include "core/parallel.h"

namespace cathlab {

using ScalarField = std::function<double(const Vec3&)>;  ///< signed distance, mm; gradient about 1 near its zero

/// The zero surface of a signed distance inside the box, on a narrow-band grid: closed, outward, vertices sorted by
/// place so that the result does not depend on the number of threads.  The surface must lie inside the box.
TriMesh mesh_level_set(const ScalarField& field, const Vec3& low, const Vec3& high, double voxel_mm,
                       const Workers& workers);

/// Signed distance (negative inside) to a closed mesh on a grid, known everywhere inside and for `outside_mm` outside.
class DistanceGrid {
public:
    DistanceGrid(const TriMesh& mesh, double voxel_mm, double inside_mm, double outside_mm, const Workers& workers);
    double value(const Vec3& p) const;  ///< trilinear; clamped to the bands
    Vec3 gradient(const Vec3& p) const;
    double voxel() const { return voxel_; }
    /// The surface at that distance from the wall (mm, negative inside, within the bands).
    TriMesh surface(double level_mm, const Workers& workers) const;

private:
    struct Grid;
    std::shared_ptr<const Grid> grid_;
    double voxel_;
};

}  // namespace cathlab
