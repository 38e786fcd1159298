#include "scene/scene_table.h"

#include "scene/anatomy_file.h"

namespace cathlab {
namespace {

constexpr Range world_mm{-5000, 5000};

Table<SceneStep> step_table() {
    return Table<SceneStep>("how a step is cut up")
        .number("dt_s", &SceneStep::dt_s, "s", {0.001, 0.1}, "length of a step")
        .integer("substeps", &SceneStep::substeps, "1", {1, 100}, "substeps of a step")
        .integer("iterations", &SceneStep::iterations, "1", {1, 50},
                 "passes over clusters, chain and contacts in a substep")
        .number("contact_margin_mm", &SceneStep::contact_margin_mm, "mm", {0.1, 20},
                "contacts are looked for nearer to the wall than this")
        .number("sample_spacing_mm", &SceneStep::sample_spacing_mm, "mm", {0.2, 10},
                "of contact samples along the devices")
        .number("wire_penetration_limit_mm", &SceneStep::wire_penetration_limit_mm, "mm", {0.01, 5},
                "the drive slips while the wire is pressed in deeper than this")
        .vec3("gravity_mm_s2", &SceneStep::gravity_mm_s2, "mm/s2", {-1e5, 1e5},
              "acts on the guidewire, in world axes; blood does not buoy it up");
}

Table<SceneAnatomy> anatomy_section() {
    const auto stenosis =
        Table<StenosisSpec>("a narrowing of a vessel of a parametric anatomy")
            .text("vessel", &StenosisSpec::vessel, "name of the vessel")
            .required()
            .number("place_mm", &StenosisSpec::place_mm, "mm", {0, 2000},
                    "of its middle, along the vessel from its first point")
            .required()
            .number("length_mm", &StenosisSpec::length_mm, "mm", {1, 100}, "length")
            .number("degree", &StenosisSpec::degree, "1", {0, 0.9}, "part of the diameter that is lost")
            .required()
            .place(&StenosisSpec::where);
    return Table<SceneAnatomy>("the vessels: either a parametric file or an imported mesh")
        .path("file", &SceneAnatomy::file, "a parametric anatomy", "assets/anatomy")
        .include(&SceneAnatomy::imported, imported_anatomy_table())
        .optional("mesh")
        .integer("face_count", &SceneAnatomy::face_count, "1", {0, 2e6},
                 "triangles of the lumen surface; 0 = as the anatomy says")
        .tables("stenosis", &SceneAnatomy::stenoses, stenosis)
        .place(&SceneAnatomy::where);
}

Table<SceneWall> wall_table() {
    const auto region =
        Table<SceneWallRegion>("what differs in one region of the wall")
            .text("name", &SceneWallRegion::name, "name of the region")
            .required()
            .number("cluster_spacing_mm", &SceneWallRegion::cluster_spacing_mm, "mm", {0.5, 50},
                    "distance between clusters")
            .number("cluster_radius_mm", &SceneWallRegion::cluster_radius_mm, "mm", {0.5, 100}, "reach of a cluster")
            .number("cluster_stiffness", &SceneWallRegion::cluster_stiffness, "1", {0, 0.999}, "t_c")
            .number("young_kpa", &SceneWallRegion::young_kpa, "kPa", {0.1, 1e6}, "Young's modulus, elastic form")
            .number("poisson", &SceneWallRegion::poisson, "1", {0, 0.4999}, "Poisson's ratio, elastic form")
            .number("particle_spacing_mm", &SceneWallRegion::particle_spacing_mm, "mm", {0.2, 10},
                    "distance between particles")
            .number("wall_thickness_mm", &SceneWallRegion::wall_thickness_mm, "mm", {0.1, 5}, "thickness of the wall")
            .number("force_limit_n", &SceneWallRegion::force_limit_n, "N", {0.01, 100}, "largest force allowed there")
            .place(&SceneWallRegion::where);
    return Table<SceneWall>("the soft wall: particles in overlapping clusters")
        .number("particle_spacing_mm", &SceneWall::particle_spacing_mm, "mm", {0.2, 10},
                "distance between particles; the anatomy's regions and narrow vessels may ask for less")
        .number("cluster_spacing_mm", &SceneWall::cluster_spacing_mm, "mm", {0.5, 50}, "distance between clusters, s_c")
        .number("cluster_radius_mm", &SceneWall::cluster_radius_mm, "mm", {0.5, 100},
                "reach of a cluster along the wall, r_c")
        .number("cluster_stiffness", &SceneWall::cluster_stiffness, "1", {0, 0.999}, "t_c, 0 = limp, near 1 = stiff")
        .choice(
            "form", &SceneWall::form, {"clusters", "elastic"},
            "what makes the wall stiff: the clusters by cluster_stiffness, or a shell by young_kpa, poisson and the "
            "regions' wall_thickness_mm; then the clusters only damp")
        .number("young_kpa", &SceneWall::young_kpa, "kPa", {0.1, 1e6},
                "Young's modulus of the wall at rest, elastic form")
        .number("poisson", &SceneWall::poisson, "1", {0, 0.4999}, "Poisson's ratio of the wall, elastic form")
        .number("density_kg_m3", &SceneWall::density_kg_m3, "kg/m3", {100, 20000}, "density of the wall")
        .number("surrounding_kpa_per_mm", &SceneWall::surrounding_kpa_per_mm, "kPa/mm", {0, 100},
                "stiffness of the tissue around the vessels, an elastic foundation; 0 = nothing around them")
        .number("surrounding_kpa_s_per_mm", &SceneWall::surrounding_kpa_s_per_mm, "kPa s/mm", {0, 10},
                "damping of that tissue")
        .number("max_speed_mm_s", &SceneWall::max_speed_mm_s, "mm/s", {1, 1e6},
                "no particle goes faster: a wall that slips off a device does not snap back at once")
        .choice("precision", &SceneWall::precision, {"float", "double"},
                "of the cluster fits; positions and forces are double in either")
        .number("damping_per_s", &SceneWall::damping_per_s, "1/s", {0, 1000},
                "rate at which motion against the clusters dies")
        .number("friction", &SceneWall::friction, "1", {0, 2},
                "Coulomb coefficient of every device against the wall, instead of the device files' own")
        .number("force_limit_share", &SceneWall::force_limit_share, "1", {0.1, 10},
                "of the force limit of every region: a harder or an easier task")
        .tables("region", &SceneWall::regions, region);
}

Table<SceneHeart> heart_table() {
    return Table<SceneHeart>("the cylinder that pushes the aortic root")
        .boolean("enabled", &SceneHeart::enabled, "the heart beats")
        .number("rate_bpm", &SceneHeart::rate_bpm, "1/min", {10, 300}, "beats a minute")
        .number("radius_mm", &SceneHeart::radius_mm, "mm", {0, 50}, "of the cylinder; 0 = from the annulus")
        .number("excursion_mm", &SceneHeart::excursion_mm, "mm", {0, 40},
                "range of the motion; 0 = as the profile stands")
        .rows("profile", &SceneHeart::profile, "1 and mm", {-40, 40}, {0, 200},
              "rows [phase of the beat from 0 to below 1, displacement in mm]; empty = built in")
        .place(&SceneHeart::where);
}

Table<SceneDevice> device_table(const std::string& doc, bool catheter) {
    Table<SceneDevice> table(doc);
    table.boolean("enabled", &SceneDevice::enabled, "the device is there")
        .path("device", &SceneDevice::device, "its device file", "assets/devices")
        .text("entry", &SceneDevice::entry,
              "name of the entry site; for a wire, of a landmark too: out of a guiding catheter engaged there")
        .number("insertion_mm", &SceneDevice::insertion_mm, "mm", {0, 2000}, "beyond the sheath's mouth at the start")
        .place(&SceneDevice::where);
    if (catheter)
        table.choice("follow", &SceneDevice::follow, {"vessel", "wire"}, "what its shaft runs along");
    else
        table.number("link_length_mm", &SceneDevice::link_length_mm, "mm", {0, 50},
                     "longest rigid link, where the device's file has longer ones; 0 = as it says");
    return table;
}

Table<SceneCArm> c_arm_table() {
    return Table<SceneCArm>("the C-arm: angles by DICOM's signs, distances, detector field")
        .text("view", &SceneCArm::view, "a view by its name in place of the two angles: see `cathlab list views`")
        .number("primary_deg", &SceneCArm::primary_deg, "deg", {-180, 180}, "positive = LAO, at the start")
        .number("secondary_deg", &SceneCArm::secondary_deg, "deg", {-90, 90}, "positive = cranial, at the start")
        .number("sid_mm", &SceneCArm::sid_mm, "mm", {600, 1500}, "source to detector")
        .number("sod_mm", &SceneCArm::sod_mm, "mm", {400, 1200}, "source to isocentre")
        .number("field_of_view_mm", &SceneCArm::field_of_view_mm, "mm", {50, 500}, "side of the square detector field")
        .name_or_point("isocentre", &SceneCArm::isocentre, world_mm,
                       "a landmark, 'centre' for the middle of the lumen's box, or a point")
        .number("frame_rate", &SceneCArm::frame_rate, "1/s", {1, 30}, "7.5, 15 or 30 frames a second")
        .choice("dose", &SceneCArm::dose, {"low", "normal", "high"}, "of fluoroscopy, at the start")
        .choice("detector", &SceneCArm::detector, {"flat_panel", "image_intensifier"},
                "what makes the picture: no part of the state")
        .place(&SceneCArm::where);
}

Table<SceneRig> rig_table() {
    const auto station =
        Table<SceneRigStation>("where a rig of kind \"stations\" loads and reads the wall")
            .text("name", &SceneRigStation::name, "of the station, for the report")
            .required()
            .text("region", &SceneRigStation::region, "of the anatomy; its middle, or place_mm along it")
            .text("landmark", &SceneRigStation::landmark, "of the anatomy; instead of a region")
            .number("place_mm", &SceneRigStation::place_mm, "mm", {0, 2000},
                    "along the region's centre-line from where it begins")
            .place(&SceneRigStation::where);
    return Table<SceneRig>("how a calibration loads the wall of this scene's anatomy; a run passes it over")
        .choice(
            "kind", &SceneRig::kind, {"auto", "tube", "stations", "ring", "strip", "block"},
            "auto = tube where the anatomy is one straight vessel, else stations; ring, strip and block are cut from "
            "such a tube")
        .number("length_mm", &SceneRig::length_mm, "mm", {1, 500}, "of a strip or block, along the pull")
        .number("width_mm", &SceneRig::width_mm, "mm", {1, 500}, "of a ring along its axis; of a strip or block")
        .tables("station", &SceneRig::stations, station)
        .place(&SceneRig::where);
}

Table<SceneTask> task_table() {
    const auto criterion = Table<SceneCriterion>("one number of the score: its part falls from 1 at full to 0 at none")
                               .text("metric", &SceneCriterion::metric, "cathlab list metrics")
                               .required()
                               .number("full", &SceneCriterion::full, "of the metric", {-1e9, 1e9}, "gives all of it")
                               .required()
                               .number("none", &SceneCriterion::none, "of the metric", {-1e9, 1e9}, "gives nothing")
                               .required()
                               .number("weight", &SceneCriterion::weight, "1", {0, 1000}, "share of the score");
    return Table<SceneTask>("what an operator is to do in this scene, and what it is worth")
        .text("landmark", &SceneTask::landmark, "of the anatomy: where the tip is to go")
        .required()
        .choice("device", &SceneTask::device, {"wire", "catheter"}, "whose tip counts")
        .text("instructions", &SceneTask::instructions, "in the trainee's words")
        .number("radius_mm", &SceneTask::radius_mm, "mm", {0.5, 100}, "of the ball about the landmark that is the goal")
        .number("hold_s", &SceneTask::hold_s, "s", {0, 60}, "how long the tip stays in it, without a break")
        .number("time_limit_s", &SceneTask::time_limit_s, "s", {1, 7200}, "from the first step")
        .number("pass_score", &SceneTask::pass_score, "1", {0, 100}, "score from which on the task is passed")
        .boolean("inner_view", &SceneTask::inner_view, "the inner view may be looked at")
        .tables("criterion", &SceneTask::criteria, criterion)
        .place(&SceneTask::where);
}

// Sections [effects.NAME] are made at run time from the manifest, one field a Parameter.
Table<SceneSpec>& add_effects(Table<SceneSpec>& scene) {
    auto effects = std::make_shared<TableSpec>();
    effects->doc = "optional physics, by name";
    effects->make_default = scene.spec().make_default;
    for (std::size_t i = 0; i < effect_table().size(); ++i) {
        const EffectInfo& info = effect_table()[i];
        FieldSpec f;
        f.key = std::string(info.name);
        f.kind = FieldKind::table;
        f.doc = std::string(info.doc);
        f.unlisted = info.for_tests;
        f.sub = std::make_shared<const TableSpec>(
            Table<SceneEffect>(f.doc)
                .boolean("enabled", &SceneEffect::enabled,
                         "switches the effect off when false; naming it switches it on")
                .parameters(info.parameters, &SceneEffect::values)
                .spec());
        f.open = [i](void* scene_spec) -> void* {
            SceneEffect& effect = static_cast<SceneSpec*>(scene_spec)->effects.at(i);
            effect.enabled = true;
            return &effect;
        };
        effects->fields.push_back(std::move(f));
    }
    FieldSpec section;
    section.key = "effects";
    section.kind = FieldKind::table;
    section.doc = effects->doc;
    section.sub = effects;
    section.open = [](void* scene_spec) { return scene_spec; };
    return scene.field(std::move(section));
}

Table<SceneSpec> make_scene_table() {
    const auto contrast =
        Table<SceneContrast>("contrast medium")
            .number("iodine_mg_ml", &SceneContrast::iodine_mg_ml, "mg/mL", {0, 400}, "iodine in the medium")
            .number("aortic_flow_ml_s", &SceneContrast::aortic_flow_ml_s, "mL/s", {0, 500},
                    "blood flow that carries the bolus")
            .name_or_point(
                "root", &SceneContrast::root, world_mm,
                "where that flow enters: a landmark at a free end, an entry, 'annulus', a point near an end, "
                "or 'auto' for the annulus or else the widest end")
            .place(&SceneContrast::where);
    const auto force = Table<SceneForce>("the force bar")
                           .number("filter_s", &SceneForce::filter_s, "s", {0, 10}, "length of its mean filter");
    const auto video = Table<SceneVideo>("the film of a run; the command line may say otherwise")
                           .integer("width", &SceneVideo::width, "1", {64, 7680}, "pixels, even")
                           .integer("height", &SceneVideo::height, "1", {64, 4320}, "pixels, even")
                           .number("fps", &SceneVideo::fps, "1/s", {1, 120}, "frames a second of simulated time");
    Table<SceneSpec> scene("a scene of cathlab: lengths in mm, angles in degrees; unknown keys are errors");
    scene.integer("schema", &SceneSpec::schema, "1", {1, 1}, "version of this format")
        .required()
        .text("name", &SceneSpec::name, "short name; the file's name if absent")
        .text("title", &SceneSpec::title, "one line for lists and for the film")
        .integer("seed", &SceneSpec::seed, "1", {0, 9007199254740991.0}, "of every random number")
        .number("duration_s", &SceneSpec::duration_s, "s", {0.001, 86400}, "simulated time of a run")
        .path("script", &SceneSpec::script, "what the operator does: a CSV file t_s,action,value")
        .table("step", &SceneSpec::step, step_table())
        .table("anatomy", &SceneSpec::anatomy, anatomy_section())
        .required()
        .table("wall", &SceneSpec::wall, wall_table())
        .table("heart", &SceneSpec::heart, heart_table())
        .table("wire", &SceneSpec::wire, device_table("the guidewire", false))
        .table("catheter", &SceneSpec::catheter, device_table("the steerable catheter", true))
        .table("c_arm", &SceneSpec::c_arm, c_arm_table())
        .table("contrast", &SceneSpec::contrast, contrast)
        .table("force", &SceneSpec::force, force)
        .table("rig", &SceneSpec::rig, rig_table())
        .table("task", &SceneSpec::task, task_table())
        .table("video", &SceneSpec::video, video);
    return add_effects(scene);
}

}  // namespace

std::vector<SceneEffect> all_effects_off() {
    std::vector<SceneEffect> out;
    for (const EffectInfo& info : effect_table()) out.push_back({&info, false, parameter_defaults(info.parameters)});
    return out;
}

const Table<SceneSpec>& scene_table() {
    static const Table<SceneSpec> table = make_scene_table();
    return table;
}

}  // namespace cathlab
