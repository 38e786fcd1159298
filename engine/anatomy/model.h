// What the rest of the house knows of an anatomy: plain arrays, const after load, shared by all worlds of a process.
// World frame: DICOM patient axes in mm (x to the patient's left, y posterior, z cranial).
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/centreline.h"
#include "core/mesh.h"
#include "core/types.h"

namespace cathlab {

/// A named part of the vessel tree.  Order of AnatomyModel::regions = the region indices everywhere.
struct Region {
    std::string name;  ///< "ascending_aorta", "left_coronary", ...
    double wall_thickness_mm = 1.0;
    double force_limit_n = 0.8;        ///< largest force allowed there (force bar = 1)
    double particle_spacing_mm = 2.1;  ///< wanted distance between wall particles
};

/// A place where a device enters.  pose.position lies on the centre-line inside the closed end of the vessel,
/// the z axis of pose points into the vessel.
struct EntrySite {
    std::string name;
    Pose pose;
    double radius_mm = 0.0;  ///< of the lumen there
    Index node = 0;          ///< of the centre-line graph
};

/// The wall is held where it lies within radius of the centre and within half_thickness of the plane through it.
struct FixedZone {
    std::string name;
    Vec3 center = Vec3::Zero();
    Vec3 normal = Vec3::UnitZ();
    double radius_mm = 0.0;
    double half_thickness_mm = 0.0;
    bool contains(const Vec3& p) const {
        const double along = (p - center).dot(normal);
        return along <= half_thickness_mm && along >= -half_thickness_mm &&
               (p - center - along * normal).squaredNorm() <= radius_mm * radius_mm;
    }
};

/// Named points for goals, views and labels: "left_coronary_ostium", "arch_top", ...  z axis = along the vessel.
struct Landmark {
    std::string name;
    Pose pose;
    double radius_mm = 0.0;
    Index node = 0;
};

/// The ring where the aorta meets the heart; pose.z points from the ventricle into the aorta.
struct Annulus {
    Pose pose;
    double radius_mm = 0.0;
};

/// A closed solid of the torso around the vessels, for the X-ray image alone.
struct ContextSolid {
    std::string name;      ///< "body", "vertebra_T12", "rib_left_5", "heart", "lung_left", ...
    std::string material;  ///< a name of the material table: "soft_tissue", "cortical_bone", "lung", ...
    std::string inside;    ///< name of the solid that surrounds it ("" for the outermost): nested media are differences
    TriMesh mesh;          ///< closed, outward
};

struct AnatomyModel {
    std::string name;
    std::uint64_t content_hash = 0;  ///< of everything it was built from and of the builder's version

    TriMesh fine;  ///< closed lumen surface, edges well under the particle spacing: the wall is sampled on it
    std::vector<Index> fine_region;   ///< one a vertex of fine
    std::vector<double> fine_radius;  ///< radius of the lumen near each vertex of fine, mm

    TriMesh lumen;  ///< closed, decimated: contact and X-ray surface; at least ten edges round every lumen
    std::vector<Index> lumen_region;   ///< one a vertex of lumen
    std::vector<double> lumen_radius;  ///< radius of the lumen near each vertex, mm

    CentrelineGraph centreline;
    std::vector<Region> regions;
    std::vector<EntrySite> entries;
    std::vector<FixedZone> fixed;
    std::vector<Landmark> landmarks;
    std::optional<Annulus> annulus;  ///< a heart may act only where there is one
    std::vector<ContextSolid> context;
};

}  // namespace cathlab
