// What a modeller may say of an anatomy: plain tables, before anything is built.
// World frame: DICOM patient axes in mm (x to the patient's left, y posterior, z cranial).  The default adult puts the
// origin at the centre of the aortic annulus.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/errors.h"
#include "core/types.h"

namespace cathlab {

/// A part of the wall with its own thickness, force limit and particle spacing.
struct RegionSpec {
    std::string name;
    double wall_thickness_mm = 1.0;    ///< [0.1, 5]
    double force_limit_n = 0.8;        ///< [0.01, 100]
    double particle_spacing_mm = 0.0;  ///< 0 = the anatomy's, or [0.2, 10]
    SourcePlace where;

    double spacing_mm(double of_the_anatomy) const {
        return particle_spacing_mm > 0.0 ? particle_spacing_mm : of_the_anatomy;
    }
};

/// One tube.  The centre-line is a centripetal Catmull-Rom curve through the points; radii go linearly with arc length
/// between them, smoothed.  A vessel with a parent starts on the parent's centre-line: its first point is snapped
/// there.
struct VesselSpec {
    std::string name;
    std::string parent;      ///< "" for the root of the tree
    std::string region;      ///< a RegionSpec's name
    bool continues = false;  ///< goes on where the parent ends, with the same tangent, without a seam
    std::vector<std::array<double, 4>> points;  ///< x, y, z, radius (mm, [0.2, 60]); two or more, 0.5 mm apart or more
    double blend = 0.6;            ///< rounding of the ostium over the smaller radius at the branch, [0, 2]
    bool fixed_end = false;        ///< the wall is held at the far end over fixed_length_mm
    double fixed_length_mm = 6.0;  ///< [0.5, 200]
    SourcePlace where;
};

/// A narrowing: radius = radius0 (1 - degree (1 + cos(2 pi u)) / 2), u = (s - place) / length in [-1/2, 1/2].
struct StenosisSpec {
    std::string vessel;
    double place_mm = 0.0;   ///< arc length from the vessel's first point
    double length_mm = 8.0;  ///< [1, 100]
    double degree = 0.0;     ///< narrowing of the diameter, [0, 0.9]
    SourcePlace where;
};

/// A bulge of the aortic root: a sphere beside the axis of the annulus.
struct SinusSpec {
    std::string name;
    double angle_deg = 0.0;   ///< about the annulus axis, seen from the ventricle's side: 0 = anterior, 90 = left
    double height_mm = 9.0;   ///< of the sphere's centre above the annulus
    double offset_mm = 7.0;   ///< of the sphere's centre from the axis
    double radius_mm = 10.0;  ///< (0, 40]
};

struct AnnulusSpec {
    std::string vessel;  ///< the vessel whose first point is the annulus' centre
    double radius_mm = 11.5;
    std::vector<SinusSpec> sinuses;
    SourcePlace where;
};

/// A device enters at the free end of a vessel, inset_mm inside the closing cap.
struct EntrySpec {
    std::string name;
    std::string vessel;
    double inset_mm = 10.0;  ///< [1, 100]
    SourcePlace where;
};

/// A named place on a vessel's centre-line.
struct LandmarkSpec {
    std::string name;
    std::string vessel;
    std::string at =
        "place";            ///< "ostium" (where the vessel leaves its parent's lumen), "start", "end", "top" or "place"
    double place_mm = 0.0;  ///< arc length from the first point, for "place"
    SourcePlace where;
};

struct MeshingSpec {
    double voxel_mm = 0.5;          ///< of the distance grid, [0.1, 3]
    int face_count = 24000;         ///< triangles of the lumen surface, met within 10 %
    int smoothing_steps = 10;       ///< Taubin steps on the grid's surface, [0, 100]
    double smoothing_lambda = 0.5;  ///< (0, 1)
    double smoothing_mu = -0.53;    ///< (-1, 0)
    double edges_round = 10.0;      ///< least number of edges round every lumen, [6, 64]
    double coarse_edge_mm = 3.6;    ///< longest wanted edge of the lumen surface before face_count scales it, [1, 20]
    double fine_edge_mm = 1.0;      ///< longest wanted edge of the fine surface, [0.2, 5]
    SourcePlace where;
};

/// The parametric tree.
struct AnatomySpec {
    std::string name = "anatomy";
    std::vector<RegionSpec> regions;
    std::vector<VesselSpec> vessels;
    std::vector<StenosisSpec> stenoses;
    std::optional<AnnulusSpec> annulus;
    std::vector<EntrySpec> entries;
    std::vector<LandmarkSpec> landmarks;
    MeshingSpec meshing;
    /// Wanted distance of wall particles where a region names none, [0.2, 10]; lowered by the builder where fewer than
    /// eight would go round a lumen.
    double particle_spacing_mm = 2.1;
    bool torso = true;  ///< put bones, lungs and a body outline round it (needs the adult's frame)
};

/// A named point near an end (entry) or near a part of the wall that is held (fixed zone) of an imported mesh.
struct ImportedEntry {
    std::string name;
    Vec3 near = Vec3::Zero();  ///< mm, in the mesh's own frame after scaling to mm; snapped to the centre-line
    double inset_mm = 6.0;     ///< [0, 100] how far inside the vessel's end the device's mouth stands
    SourcePlace where;
};

struct ImportedFixed {
    std::string name;
    Vec3 center = Vec3::Zero();
    double radius_mm = 10.0;
    SourcePlace where;
};

struct ImportedAnnulus {
    Vec3 center = Vec3::Zero();
    Vec3 axis = Vec3::UnitZ();  ///< from the ventricle into the aorta
    double radius_mm = 12.0;
};

/// A patient's vessels from a triangle mesh (OBJ, STL, PLY, GLB, glTF).
struct ImportedAnatomySpec {
    std::string name = "imported";
    std::string mesh;         ///< path
    std::string unit = "mm";  ///< "mm", "cm" or "m"
    std::vector<ImportedEntry> entries;
    std::vector<ImportedFixed> fixed;  ///< beside the ends, which are always held
    std::vector<ImportedEntry> landmarks;
    std::optional<ImportedAnnulus> annulus;
    double wall_thickness_mm = 1.0;
    double force_limit_n = 0.8;
    double particle_spacing_mm = 2.1;
    double edges_round = 10.0;
    int face_count = 0;  ///< of the lumen; 0 = as many as edges_round asks for
    SourcePlace where;
};

/// Throws UserError for what cannot be built: unknown names (with the nearest known one), fewer than two points,
/// lengths of zero, radii that are not positive, numbers that are not finite, ranges above.
void validate(const AnatomySpec& spec);
void validate(const ImportedAnatomySpec& spec);

/// Hash of everything that shapes the model (not of the places in files).
std::uint64_t content_hash(const AnatomySpec& spec);
std::uint64_t content_hash(
    const ImportedAnatomySpec& spec);  ///< includes the mesh file's bytes; UserError if unreadable

}  // namespace cathlab
