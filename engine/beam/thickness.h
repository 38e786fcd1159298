// How thick the patient is for the beam: what the automatic exposure needs, without a renderer.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "beam/c_arm.h"
#include "core/mesh.h"

namespace cathlab {

/// A closed solid of one material that lies in another ("" = air).  Nested media are differences: a solid inside
/// another adds (mu - mu of what surrounds it) times its own path length.
struct BodySolid {
    const TriMesh* mesh = nullptr;  ///< closed, outward; outlives this
    std::string material;           ///< of material_table()
    std::string surrounded_by;      ///< material of the solid that it lies in
};

/// Const after load.
class BodyThickness {
public:
    BodyThickness() = default;
    /// Throws UserError for an unknown material.
    explicit BodyThickness(std::span<const BodySolid> solids, double energy_kev = 60.0);

    /// Water that attenuates as much as the body does at energy_kev, mm: the mean over the central ray and four rays at
    /// a fifth of the field around it.  0 without solids.
    double water_mm(const CArmSpec& spec, const CArmPose& pose) const;

private:
    struct Part {
        const TriMesh* mesh;
        double water_per_mm;  // difference of attenuation over that of water
        Vec3 center;
        double radius;  // of a ball that holds the mesh
    };
    std::vector<Part> parts_;
};

/// Length of a line inside a closed mesh, mm: sum of +depth where it leaves and -depth where it enters.  A line through
/// an edge or a corner is counted once (ties are broken by the order of the vertices, alike for both triangles of an
/// edge).
double path_length(const TriMesh& mesh, const Vec3& origin, const Vec3& direction);

}  // namespace cathlab
