#include "scene/build_world.h"

#include <algorithm>
#include <cmath>

#include "anatomy/build.h"
#include "beam/exposure.h"
#include "beam/thickness.h"
#include "catheter/motion.h"
#include "catheter/mount.h"
#include "contact/lumen_surface.h"
#include "contrast/transport.h"
#include "core/units.h"
#include "heart/motion.h"
#include "rod/rod.h"
#include "scene/anatomy_file.h"
#include "scene/device_file.h"
#include "scene/entry.h"
#include "scene/flow_root.h"
#include "scene/vessel_direction.h"
#include "scene/wall_parameters.h"
#include "softbody/binding.h"
#include "softbody/solver.h"
#include "softbody/wall_place.h"
#include "softbody/wall_sample.h"
#include "world/step_settings.h"

namespace cathlab {

struct SceneModels {
    Shared<AnatomyModel> anatomy;
    Shared<SoftBodyModel> wall;
    Shared<LumenSurfaceModel> surface;
    Shared<BodyThickness> thickness;
    Shared<ContrastModel> contrast;
};

namespace {

// Particles over which a vertex of the lumen surface spreads its force.
constexpr int surface_particles = 10;

AnatomyModel get_anatomy(const SceneSpec& spec, const BuildOptions& options, const Workers& workers) {
    const auto progress = [&](double fraction, std::string_view what) {
        if (options.progress) options.progress(0.6 * fraction, what);
    };
    if (!spec.anatomy.imported.mesh.empty()) {
        ImportedAnatomySpec imported = spec.anatomy.imported;
        imported.where = spec.anatomy.where;
        return load_or_build(imported, options.cache_folder, workers, progress);
    }
    AnatomySpec anatomy = load_anatomy(spec.anatomy.file);
    anatomy.stenoses.insert(anatomy.stenoses.end(), spec.anatomy.stenoses.begin(), spec.anatomy.stenoses.end());
    anatomy.particle_spacing_mm = spec.wall.particle_spacing_mm;
    if (spec.anatomy.face_count > 0) anatomy.meshing.face_count = spec.anatomy.face_count;
    return load_or_build(anatomy, options.cache_folder, workers, progress);
}

Shared<SoftBodyModel> build_wall(const SceneSpec& spec, AnatomyModel& anatomy) {
    WallParameters parameters = wall_parameters(spec.wall);
    parameters.regions = apply_wall(spec.wall, anatomy.regions);

    std::vector<double> wanted;
    std::vector<double> thickness;
    for (const Region& region : anatomy.regions) thickness.push_back(region.wall_thickness_mm);
    for (const Index region : anatomy.fine_region)
        wanted.push_back(anatomy.regions[static_cast<std::size_t>(region)].particle_spacing_mm);
    const std::vector<double> spacing = lumen_spacing(wanted, anatomy.fine_radius);
    WallSample sample = sample_wall(anatomy.fine, anatomy.fine_region, spacing, thickness, 1);
    if (parameters.form == WallForm::elastic) sample.along = vessel_directions(anatomy.centreline, sample.position);
    const auto is_fixed = [&](const Vec3& p) {
        return std::any_of(anatomy.fixed.begin(), anatomy.fixed.end(),
                           [&](const FixedZone& zone) { return zone.contains(p); });
    };
    return std::make_shared<const SoftBodyModel>(build_soft_body(sample, parameters, is_fixed));
}

bool passive_catheter(const SceneSpec& spec) {
    return spec.catheter.enabled && device_kind(spec.catheter.device) == "passive_catheter";
}

void add_wire(World& world, const SceneSpec& spec, const AnatomyModel& anatomy) {
    WireSpec wire = load_wire(spec.wire.device);
    wire.friction = spec.wall.friction.value_or(wire.friction);
    if (const double longest = spec.wire.link_length_mm; longest > 0.0) {
        wire.link_length_mm = std::min(wire.link_length_mm, longest);
        for (WireSection& section : wire.sections) section.link_length_mm = std::min(section.link_length_mm, longest);
    }
    const WayIn way = find_way_in(anatomy, spec.wire, true);
    const EntrySite& entry = way.entry;
    for (const WireSection& section : wire.sections) check_width(way, 0.5 * section.diameter_mm, spec.wire);
    check_insertion(way, wire.length_mm, spec.wire);
    const SheathPose sheath{entry.pose, 60.0};
    const Entity e = world.create(wire_entity);
    if (way.guided() && spec.catheter.enabled)
        throw UserError(spec.catheter.where, "the wire comes out of a guiding catheter at '" + entry.name +
                                                 "': a scene with one has no other catheter");
    if (way.guided()) {
        world.add(e, wall_place(**world.first<Shared<SoftBodyModel>>(), entry.pose));
        world.add(e, GuidePath{way.guide});
    }
    if (!passive_catheter(spec)) {
        world.add(e, Rod(wire, sheath, spec.wire.insertion_mm, way.points));
        return;
    }
    SleeveSpec sleeve = load_sleeve(spec.catheter.device);
    sleeve.friction = spec.wall.friction.value_or(sleeve.friction);
    if (spec.catheter.entry != spec.wire.entry)
        throw UserError(spec.catheter.where, "entry: found '" + spec.catheter.entry +
                                                 "'; a passive catheter runs over the wire, which enters at '" +
                                                 spec.wire.entry + "'");
    for (const WireSection& section : sleeve.sections) check_width(way, 0.5 * section.diameter_mm, spec.catheter);
    check_insertion(way, sleeve.length_mm, spec.catheter);
    world.add(e, Rod(wire, sleeve, sheath, spec.wire.insertion_mm, spec.catheter.insertion_mm, way.points));
}

void add_catheter(World& world, const SceneSpec& spec, const AnatomyModel& anatomy) {
    CatheterSpec catheter = load_catheter(spec.catheter.device);
    catheter.friction = spec.wall.friction.value_or(catheter.friction);
    const WayIn way = find_way_in(anatomy, spec.catheter, false);
    check_width(way, catheter.radius_mm(), spec.catheter);
    check_insertion(way, catheter.length_mm, spec.catheter);
    const Entity e = world.create(catheter_entity);
    world.add(e, CatheterMount{way.entry.pose, way.entry.node, spec.catheter.follow == "wire"});
    world.add(e, initial_state(catheter, spec.catheter.insertion_mm));
    world.add(e, std::move(catheter));
}

Shared<BodyThickness> body_thickness(const AnatomyModel& anatomy) {
    std::vector<BodySolid> solids;
    for (const ContextSolid& solid : anatomy.context) {
        const auto parent = std::find_if(anatomy.context.begin(), anatomy.context.end(),
                                         [&](const ContextSolid& other) { return other.name == solid.inside; });
        solids.push_back({&solid.mesh, solid.material, parent == anatomy.context.end() ? "" : parent->material});
    }
    return std::make_shared<const BodyThickness>(solids);
}

Vec3 isocentre(const SceneSpec& spec, const AnatomyModel& anatomy) {
    if (spec.c_arm.isocentre.name.empty()) return spec.c_arm.isocentre.point;
    if (spec.c_arm.isocentre.name == "centre") {
        Vec3 low = anatomy.lumen.vertices.front();
        Vec3 high = low;
        for (const Vec3& v : anatomy.lumen.vertices) {
            low = low.cwiseMin(v);
            high = high.cwiseMax(v);
        }
        return 0.5 * (low + high);
    }
    std::vector<std::string> names{"centre"};
    for (const Landmark& landmark : anatomy.landmarks) {
        if (landmark.name == spec.c_arm.isocentre.name) return landmark.pose.position;
        names.push_back(landmark.name);
    }
    throw UserError(spec.c_arm.where, "isocentre: the anatomy has no landmark '" + spec.c_arm.isocentre.name +
                                          "'; it has " + comma_list(names) +
                                          did_you_mean(spec.c_arm.isocentre.name, names));
}

void add_camera(World& world, const SceneSpec& spec, const SceneModels& models) {
    BeamSpec beam = beam_spec(spec, *models.anatomy);
    const Entity camera = world.create(camera_entity);
    world.add(camera, initial_state(beam));
    world.add(camera, std::move(beam));
    world.add(camera, models.thickness);
    const Entity contrast = world.create(contrast_entity);
    world.add(contrast, initial_state(*models.contrast));
    world.add(contrast, models.contrast);
}

HeartSpec heart_spec(const SceneSpec& spec, const AnatomyModel& anatomy) {
    HeartSpec heart;
    heart.rate_bpm = spec.heart.rate_bpm;
    heart.radius_mm = spec.heart.radius_mm > 0.0 ? spec.heart.radius_mm : 1.5 * anatomy.annulus->radius_mm;
    if (!spec.heart.profile.empty()) {
        heart.knots.clear();
        for (const auto& [phase, displacement] : spec.heart.profile) heart.knots.push_back({phase, displacement});
    }
    if (spec.heart.excursion_mm > 0.0) {
        double least = heart.knots.front().displacement_mm;
        double most = least;
        for (const HeartKnot& knot : heart.knots) {
            least = std::min(least, knot.displacement_mm);
            most = std::max(most, knot.displacement_mm);
        }
        for (HeartKnot& knot : heart.knots)
            knot.displacement_mm =
                most > least ? (knot.displacement_mm - least) * spec.heart.excursion_mm / (most - least) : 0.0;
    }
    validate(heart, spec.heart.where);
    return heart;
}

}  // namespace

BeamSpec beam_spec(const SceneSpec& spec, const AnatomyModel& anatomy) {
    BeamSpec beam;
    beam.c_arm.sid_mm = spec.c_arm.sid_mm;
    beam.c_arm.sod_mm = spec.c_arm.sod_mm;
    beam.c_arm.field_mm = spec.c_arm.field_of_view_mm;
    beam.isocentre = isocentre(spec, anatomy);
    beam.primary_deg = spec.c_arm.primary_deg;
    beam.secondary_deg = spec.c_arm.secondary_deg;
    beam.pulses_per_s = spec.c_arm.frame_rate;
    validate(beam, spec.c_arm.where);
    return beam;
}

std::shared_ptr<const AnatomyModel> build_anatomy(const SceneSpec& spec, const BuildOptions& options) {
    return std::make_shared<const AnatomyModel>(get_anatomy(spec, options, Workers(options.threads)));
}

std::shared_ptr<const SceneModels> build_models(const SceneSpec& spec, const BuildOptions& options) {
    const Workers workers(options.threads);
    const auto report = [&](double fraction, std::string_view what) {
        if (options.progress) options.progress(fraction, what);
    };
    auto anatomy = std::make_shared<AnatomyModel>(get_anatomy(spec, options, workers));
    auto models = std::make_shared<SceneModels>();
    report(0.6, "wall");
    models->wall = build_wall(spec, *anatomy);
    report(0.9, "surface");
    PointBinding binding =
        bind_points(*models->wall, anatomy->lumen.vertices, surface_particles, true, vertex_normals(anatomy->lumen));
    models->surface = std::make_shared<const LumenSurfaceModel>(
        build_lumen_surface(anatomy->lumen, anatomy->lumen_region, anatomy->lumen_radius, std::move(binding)));
    ContrastSpec contrast;
    contrast.cardiac_output_ml_s = spec.contrast.aortic_flow_ml_s;
    contrast.concentration_mgi_ml = spec.contrast.iodine_mg_ml;
    models->contrast = std::make_shared<const ContrastModel>(
        build_contrast(anatomy->centreline, flow_root(*anatomy, spec.contrast), contrast));
    models->thickness = body_thickness(*anatomy);
    models->anatomy = std::move(anatomy);
    report(1.0, "ready");
    return models;
}

std::unique_ptr<World> build_world(const SceneSpec& spec, const SceneModels& models, std::uint64_t seed, int threads) {
    auto world = std::make_unique<World>(seed, Workers(threads));
    const Entity top = world->create(world_entity);
    StepSettings settings;
    settings.dt = spec.step.dt_s;
    settings.substeps = spec.step.substeps;
    settings.iterations = spec.step.iterations;
    settings.contact_margin_mm = spec.step.contact_margin_mm;
    settings.sample_spacing_mm = spec.step.sample_spacing_mm;
    settings.force_filter_s = spec.force.filter_s;
    settings.wire_penetration_limit_mm = spec.step.wire_penetration_limit_mm;
    settings.gravity_mm_s2 = spec.step.gravity_mm_s2;
    world->add(top, settings);
    const Entity vessel = world->create(vessel_entity);
    world->add(vessel, models.anatomy);
    world->add(vessel, models.wall);
    world->add(vessel, models.surface);
    world->add(vessel, rest_state(*models.wall));

    if (spec.wire.enabled) add_wire(*world, spec, *models.anatomy);
    if (passive_catheter(spec)) {
        if (!spec.wire.enabled) throw UserError(spec.catheter.where, "a passive catheter needs a wire to run over");
    } else if (spec.catheter.enabled) {
        add_catheter(*world, spec, *models.anatomy);
    }
    if (spec.heart.enabled) {
        if (!models.anatomy->annulus)
            throw UserError(spec.heart.where, "the heart is enabled, but the anatomy '" + models.anatomy->name +
                                                  "' declares no annulus for it to push");
        const Entity heart = world->create(heart_entity);
        HeartSpec built = heart_spec(spec, *models.anatomy);
        world->add(heart, initial_state(built));
        world->add(heart, std::move(built));
    }
    add_camera(*world, spec, models);
    for (const SceneEffect& effect : spec.effects) {
        if (!effect.enabled) continue;
        const Entity e = world->create("effect." + std::string(effect.info->name));
        world->add(e, ActiveEffect{effect.info, effect.info->make(effect.values)});
    }
    return world;
}

std::unique_ptr<World> build_world(const SceneSpec& spec, const BuildOptions& options) {
    return build_world(spec, *build_models(spec, options), spec.seed, options.threads);
}

const AnatomyModel& anatomy_of(const SceneModels& models) {
    return *models.anatomy;
}

std::uint64_t anatomy_hash(const SceneModels& models) {
    return models.anatomy->content_hash;
}

}  // namespace cathlab
