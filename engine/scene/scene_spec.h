// A scene as plain numbers and names: what a scene file says after overlays, checks and defaults.  Lengths in mm.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "anatomy/spec.h"
#include "core/errors.h"
#include "core/types.h"
#include "effects/effect.h"
#include "scene/toml_table.h"

namespace cathlab {

/// [step]: how a step is cut up.
struct SceneStep {
    double dt_s = 0.02;
    int substeps = 4;
    int iterations = 2;
    double contact_margin_mm = 1.5;
    double sample_spacing_mm = 1.25;
    double wire_penetration_limit_mm = 0.2;
    Vec3 gravity_mm_s2 = Vec3::Zero();
};

/// [anatomy]: exactly one of file (parametric, with its stenoses) and imported.mesh.
struct SceneAnatomy {
    std::string file;                    ///< path, or ""
    ImportedAnatomySpec imported;        ///< imported.mesh: path, or ""
    std::vector<StenosisSpec> stenoses;  ///< added to those of the file
    int face_count = 0;                  ///< triangles of the lumen surface; 0 = as the anatomy says
    SourcePlace where;
};

/// [[wall.region]]: what differs in one region of the wall.
struct SceneWallRegion {
    std::string name;
    std::optional<double> cluster_spacing_mm, cluster_radius_mm, cluster_stiffness, young_kpa, poisson;
    std::optional<double> particle_spacing_mm, wall_thickness_mm, force_limit_n;
    SourcePlace where;
};

/// [wall]: the soft body.
struct SceneWall {
    double particle_spacing_mm = 2.1;  ///< in the aorta; narrower vessels get at least eight particles round the lumen
    double cluster_spacing_mm = 8.0;
    double cluster_radius_mm = 12.0;
    std::string form = "clusters";   ///< or "elastic": what makes the wall stiff
    double cluster_stiffness = 0.8;  ///< t_c
    double young_kpa = 500.0;        ///< of the elastic form
    double poisson = 0.49;           ///< of the elastic form
    double density_kg_m3 = 1060.0;
    double damping_per_s = 10.0;
    double surrounding_kpa_per_mm = 0.02;     ///< elastic foundation: tissue around the vessels
    double surrounding_kpa_s_per_mm = 0.002;  ///< its damping
    double max_speed_mm_s = 150.0;
    std::string precision = "float";  ///< of the cluster fits; positions are double in either
    std::optional<double> friction;   ///< of every device against the wall; empty = each device's own
    double force_limit_share = 1.0;   ///< of the force limit of every region
    std::vector<SceneWallRegion> regions;
};

/// [heart]: the cylinder that pushes the root.
struct SceneHeart {
    bool enabled = false;
    double rate_bpm = 67.2;
    double radius_mm = 0.0;                      ///< 0 = from the annulus
    double excursion_mm = 0.0;                   ///< > 0 scales the profile to this range; 0 = as it stands
    std::vector<std::array<double, 2>> profile;  ///< (phase of the beat 0..1, displacement in mm); empty = built in
    SourcePlace where;
};

/// [wire] and [catheter]
struct SceneDevice {
    bool enabled = false;
    std::string device;  ///< path of the device file
    std::string entry = "right_femoral";
    double insertion_mm = 50.0;     ///< beyond the sheath's mouth at the start
    std::string follow = "vessel";  ///< catheter alone: "vessel" or "wire"
    double link_length_mm = 0.0;    ///< wire alone: longest rigid link; 0 = as its file says
    SourcePlace where;
};

/// [c_arm]
struct SceneCArm {
    std::string view;            ///< name of a preset that sets both angles; "" = as they are given
    double primary_deg = 0.0;    ///< + LAO
    double secondary_deg = 0.0;  ///< + cranial
    double sid_mm = 1050.0;
    double sod_mm = 750.0;
    double field_of_view_mm = 320.0;                ///< side of the square detector field
    NameOrPoint isocentre{"centre", Vec3::Zero()};  ///< a landmark, "centre" (middle of the lumen's box), or a point
    double frame_rate = 15.0;
    std::string dose = "normal";          ///< of fluoroscopy at the start: "low", "normal" or "high"
    std::string detector = "flat_panel";  ///< or "image_intensifier": of the pictures alone
    SourcePlace where;
};

/// [contrast]
struct SceneContrast {
    double iodine_mg_ml = 320.0;
    double aortic_flow_ml_s = 80.0;          ///< mean flow of blood that carries the bolus
    NameOrPoint root{"auto", Vec3::Zero()};  ///< where that flow enters: see flow_root.h
    SourcePlace where;
};

/// [force]
struct SceneForce {
    double filter_s = 0.2;  ///< of the force bar's mean filter
};

/// [[rig.station]]: where a rig of kind "stations" loads and reads the wall.
struct SceneRigStation {
    std::string name;
    std::string region;              ///< of the anatomy, or "": then landmark says where
    std::string landmark;            ///< of the anatomy, or "": then region and place_mm say where
    std::optional<double> place_mm;  ///< along the region's centre-line from where it begins; empty = its middle
    SourcePlace where;
};

/// [rig]: how a calibration loads the wall of the scene's anatomy.  A run passes it over.
struct SceneRig {
    std::string kind = "auto";                  ///< auto, tube, stations, ring, strip, block
    std::optional<double> length_mm, width_mm;  ///< of the piece that ring, strip and block are cut to
    std::vector<SceneRigStation> stations;      ///< empty = one in each region that has room
    SourcePlace where;
};

/// [[task.criterion]]: one number of the score.
struct SceneCriterion {
    std::string metric;
    double full = 0.0, none = 1.0, weight = 1.0;
};

/// [task]: what an operator is to do in this scene, and what it is worth.
struct SceneTask {
    std::string landmark;  ///< of the anatomy, where the tip is to go; "" = this scene sets no task
    std::string device = "wire";
    std::string instructions;
    double radius_mm = 5.0;
    double hold_s = 2.0;
    double time_limit_s = 300.0;
    double pass_score = 60.0;
    bool inner_view = true;  ///< may be looked at
    std::vector<SceneCriterion> criteria;
    SourcePlace where;
};

/// [effects.NAME]: a section switches the effect on unless it says enabled = false.
struct SceneEffect {
    const EffectInfo* info = nullptr;
    bool enabled = false;
    std::vector<double> values;  ///< in the order of info->parameters
};

/// One entry an effect of the manifest, switched off, with its default values.
std::vector<SceneEffect> all_effects_off();

/// [video]
struct SceneVideo {
    int width = 1024;
    int height = 512;
    double fps = 15.0;
};

struct SceneSpec {
    int schema = 1;
    std::string name;
    std::string title;
    std::uint64_t seed = 1;
    double duration_s = 60.0;
    std::string script;  ///< path, or ""
    SceneStep step;
    SceneAnatomy anatomy;
    SceneWall wall;
    SceneHeart heart;
    SceneDevice wire;
    SceneDevice catheter;
    SceneCArm c_arm;
    SceneContrast contrast;
    SceneForce force;
    SceneRig rig;
    SceneTask task;
    std::vector<SceneEffect> effects = all_effects_off();  ///< one an entry of effect_table(), in its order
    SceneVideo video;

    std::string path;                   ///< the scene file
    std::vector<std::string> overlays;  ///< the files laid over it, in order
    std::uint64_t hash = 0;  ///< of the merged document and of the anatomy and device files it names; not of the script
};

}  // namespace cathlab
