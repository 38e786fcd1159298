// Everything that a picture needs, as plain data: window, video and tests draw the same from the same description.
// Fill one object again and again: vectors keep their memory, and what is marked by a revision is uploaded only once.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/mesh.h"
#include "core/types.h"
#include "imaging/draw_list.h"

namespace cathlab {

/// Where source and detector stand.  World frame, mm.
struct CArmView {
    Vec3 source = Vec3(0, 810, 0);
    Vec3 detector_center = Vec3(0, -390, 0);
    Vec3 right = Vec3(1, 0, 0);  ///< unit vector in the detector plane along an image row (patient's left in AP)
    Vec3 down = Vec3(0, 0, -1);  ///< unit vector down the image, orthogonal to right
    double width_mm = 300.0;     ///< extent of the picture at the detector
    double height_mm = 300.0;
    double open_width = 1.0;  ///< share of it that the collimator leaves open, (0, 1]
    double open_height = 1.0;
    double source_isocentre_mm = 0.0;  ///< sets the focal spot's blur, M = SID / SOD; 0: M = 1.45
};

/// A closed solid of the torso.  mesh in the solid's own frame, outward.
struct FrameSolid {
    std::string material;     ///< of the material table
    std::string surrounding;  ///< material of what it lies in; "air" for the outermost
    TriMesh mesh;
    Pose pose;            ///< solid -> world
    bool moving = false;  ///< drawn anew in each frame; the others are drawn again only when view or revision change
};

/// The vessel's inner surface as it stands now, closed, outward.
struct FrameLumen {
    std::vector<Vec3> vertices;       ///< (n) mm, world, deformed
    std::vector<Vec3> normals;        ///< (n) outward unit normals; empty: computed
    std::vector<Triangle> triangles;  ///< (m) const for one topology_revision
    std::vector<double> wall_mm;      ///< (n) wall thickness, outer surface = vertex + wall_mm * normal; may be empty
    std::vector<double> contrast_mg_ml;   ///< (n) iodine in the blood, mg/mL; empty: none
    std::vector<double> radius_mm;        ///< (n) of the lumen near each vertex, > 0; empty: alike everywhere
    std::vector<double> wall_force_n;     ///< (n) force on the wall near each vertex, N; empty: none
    std::vector<double> displacement_mm;  ///< (n) way from the rest position; empty: none
    std::uint64_t topology_revision = 0;
    std::string material = "blood";
    std::string surrounding = "soft_tissue";
    std::string wall_material;  ///< "" = like its surrounding (then the outer surface costs nothing)
};

/// A wire, catheter or sheath: a chain of round pieces.
struct FrameDevice {
    std::string name;
    std::vector<Vec3> points;               ///< (n + 1) joints, mm, world
    std::vector<double> radius_mm;          ///< (n) outer radius of each piece
    std::vector<double> inner_radius_mm;    ///< (n) radius of the bore; empty: solid
    std::vector<std::string> materials;     ///< names used below
    std::vector<std::uint8_t> material_of;  ///< (n) index into materials
    std::string surrounding = "blood";
    Vec3 color = Vec3(0.75, 0.78, 0.82);  ///< linear RGB for the optical views
};

/// What turns X-rays into a picture.  As it stands: a flat panel.
struct FrameDetector {
    double blur_sigma_mm = 0.18;            ///< of the scintillator's Gaussian point spread, at the detector
    double electronic_noise_photons = 2.0;  ///< rms per pixel, in detected photons
    double glare = 0.0;                     ///< share of the light that is spread over the picture, [0, 1)
    double glare_sigma_mm = 60.0;           ///< how far
    double pincushion = 0.0;   ///< a place at the picture's edge is shown farther out by this share of the radius
    bool round_field = false;  ///< black outside the largest circle
};

/// "flat_panel" or "image_intensifier"; throws UserError for any other name.
FrameDetector detector_preset(const std::string& name);

/// Beam, detector and what is made of the signal.
struct FrameExposure {
    double kvp = 80.0;                 ///< [40, 150]
    double copper_mm = 0.3;            ///< added filtration, [0, 1.5]
    double detector_kerma_ngy = 40.0;  ///< per frame, mean over the measuring field, > 0
    double open_field_kerma_ngy =
        0.0;  ///< > 0: kerma without a patient; then brightness follows the tube, not the field
    std::optional<double> scatter_to_primary;  ///< behind the grid, [0, 5]; unset: from the patient (scatter.h)
    FrameDetector detector;
    double focal_spot_mm = 0.6;      ///< blur (M - 1) * focal spot of what lies at the isocentre
    double recursion = 0.45;         ///< b of y = (1 - b) x + b y', [0, 0.95]
    double edge_enhancement = 0.35;  ///< of the log image, small neighbourhood
    double harmonisation = 0.7;      ///< share of the coarse log image that is taken off, [0, 1]
    double window = 2.0;             ///< width of the grey scale in units of ln(intensity)
    double level = 0.58;             ///< grey (0..1) of the measuring field's middle
    double measuring_field = 0.5;    ///< side of the central square that holds the kerma, share of the picture
};

/// What is made of a series of pictures.  The renderer keeps what it needs of those that it has drawn.
struct FrameSeries {
    std::uint64_t number = 0;  ///< another number: another series, with another mask
    bool subtracted = false;   ///< DSA: ln(picture) - ln(mask), the mask being the mean of the series' first pictures
    bool collected = false;  ///< the deepest shadow of the medium is kept as the roadmap (where there is medium at all)
    bool roadmap = false;    ///< the vessels of the roadmap lie bright under the picture, if it is from the same place
    std::uint64_t references = 0;  ///< as this changes, the last picture is kept as the reference
};

/// A camera at the device's tip.
struct FrameCamera {
    Pose pose;                      ///< z forward, x right, y down
    double field_of_view_deg = 90;  ///< vertical, (10, 150)
    double light_range_mm = 32;     ///< where the headlight has fallen to a quarter
};

/// What colours the wall in the outer view.
enum class OuterMap { force, displacement };

struct FrameDescription {
    int width = 1024;  ///< of the whole picture, pixels
    int height = 512;
    bool show_fluoroscopy = true;
    bool show_inner_view = true;
    bool show_outer_view = false;  ///< third person: below the inner view, or in its place
    bool show_reference = false;   ///< the reference picture: likewise

    std::uint64_t seed = 1;
    std::uint64_t frame_index = 0;  ///< noise is a pure function of (seed, frame_index, pixel)
    bool beam_on = true;            ///< false: last image hold, no noise anew

    CArmView view;
    FrameExposure exposure;
    FrameSeries series;
    std::vector<FrameSolid> solids;
    std::uint64_t solids_revision = 0;  ///< raise it when a mesh or material of `solids` changes
    FrameLumen lumen;
    std::vector<FrameDevice> devices;
    std::optional<FrameCamera> inner_camera;
    std::optional<FrameCamera> outer_camera;
    OuterMap outer_map = OuterMap::displacement;
    double wall_force_limit_n = 0.8;  ///< wall_force_n of this size is shown in full alarm colour
    HudDrawList overlay;              ///< painted last; may be empty
};

}  // namespace cathlab
