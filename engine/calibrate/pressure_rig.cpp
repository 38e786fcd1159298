#include "calibrate/pressure_rig.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "anatomy/model.h"
#include "contact/lumen_surface.h"
#include "core/errors.h"
#include "effects/effect.h"
#include "scene/anatomy_file.h"
#include "scene/wall_parameters.h"
#include "softbody/binding.h"
#include "softbody/solver.h"
#include "step/step.h"
#include "world/step_settings.h"

namespace cathlab {
namespace {

constexpr double step_s = 0.005;
constexpr double velocity_kept = 0.9;  // a step; bleeding moves no equilibrium
constexpr int steps_a_look = 5;
constexpr int most_looks = 1000;
constexpr double still_mm = 4e-4;  // the fastest particle in a look: the strain is then right to 3e-5
constexpr double held_mm = 2.5;    // of either end
constexpr int surface_particles = 6;

Vec3 radial_part(const Vec3& p, const TubeShape& shape) {
    const Vec3 off = p - shape.start;
    return off - off.dot(shape.axis) * shape.axis;
}

double along(const Vec3& p, const TubeShape& shape) {
    return (p - shape.start).dot(shape.axis);
}

/// The load as an effect of this one world: the step asks it where it asks every other.
class RadialLoad final : public Effect {
public:
    void force(const EffectContext& /*context*/, std::span<Vec3> force) override {
        for (std::size_t i = 0; i < force.size(); ++i) force[i] += load[i];
    }
    std::vector<Vec3> load;  // mN
};

constexpr const char* load_name = "radial_load";

const EffectInfo& load_info() {
    static const EffectInfo info{load_name, "the load of a rig", "", hook_force, false, {}, {}, nullptr};
    return info;
}

struct Tube {
    std::unique_ptr<World> world;
    Shared<SoftBodyModel> wall;
    std::vector<double> area_mm2;
    RadialLoad* load = nullptr;
};

Tube build_tube(const PressureRig& rig, const SceneSpec& scene) {
    WallSample sample = tube_sample(rig.shape, scene.wall.particle_spacing_mm, rig.thickness_mm, rig.seed);
    WallParameters parameters = wall_parameters(scene.wall);
    parameters.surrounding_kpa_per_mm = 0.0;
    parameters.surrounding_kpa_s_per_mm = 0.0;
    Tube tube;
    tube.wall = std::make_shared<const SoftBodyModel>(build_soft_body(sample, parameters, [&](const Vec3& p) {
        return along(p, rig.shape) < held_mm || along(p, rig.shape) > rig.shape.length_mm - held_mm;
    }));
    tube.area_mm2 = std::move(sample.area_mm2);

    // No device ever touches the surface; the step wants one, and a coarse one is cheap.
    TubeShape coarse = rig.shape;
    coarse.edge_mm = 0.5 * rig.shape.radius_mm;
    const TriMesh lumen = tube_mesh(coarse);
    auto anatomy = std::make_shared<AnatomyModel>();
    anatomy->name = "tube";
    Region region;
    region.wall_thickness_mm = rig.thickness_mm;
    anatomy->regions.push_back(region);

    tube.world = std::make_unique<World>(rig.seed, Workers(1));
    StepSettings settings;
    settings.dt = step_s;
    settings.substeps = 1;
    settings.iterations = scene.step.iterations;
    tube.world->add(tube.world->create(world_entity), settings);
    const Entity vessel = tube.world->create(vessel_entity);
    tube.world->add(vessel, Shared<AnatomyModel>(std::move(anatomy)));
    tube.world->add(vessel, tube.wall);
    tube.world->add(vessel, Shared<LumenSurfaceModel>(std::make_shared<const LumenSurfaceModel>(build_lumen_surface(
                                lumen, {}, {}, bind_points(*tube.wall, lumen.vertices, surface_particles, true)))));
    tube.world->add(vessel, rest_state(*tube.wall));
    const auto add_effect = [&](const EffectInfo& info, std::unique_ptr<Effect> effect) {
        tube.world->add(tube.world->create("effect." + std::string(info.name)), ActiveEffect{&info, std::move(effect)});
    };
    for (const SceneEffect& effect : scene.effects)
        if (effect.enabled) add_effect(*effect.info, effect.info->make(effect.values));
    auto load = std::make_unique<RadialLoad>();
    load->load.assign(tube.wall->size(), Vec3::Zero());
    tube.load = load.get();
    add_effect(load_info(), std::move(load));
    return tube;
}

double largest_move(std::span<const Vec3> a, std::span<const Vec3> b) {
    double squared = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        const double moved = (a[i] - b[i]).squaredNorm();
        if (!(moved <= squared)) squared = moved;  // NaN is kept and never still
    }
    return std::sqrt(squared);
}

double mean_strain(const Tube& tube, const TubeShape& shape, std::span<const Vec3> x) {
    double sum = 0.0;
    int count = 0;
    for (std::size_t i = 0; i < x.size(); ++i) {
        if (std::fabs(along(tube.wall->rest[i], shape) / shape.length_mm - 0.5) > 1.0 / 6.0) continue;
        const double r = std::sqrt(radial_part(x[i], shape).squaredNorm());
        sum += r / std::sqrt(radial_part(tube.wall->rest[i], shape).squaredNorm()) - 1.0;
        ++count;
    }
    return sum / count;
}

// Force over area at rest that goes with a stress at a strain, kPa.
double traction(const PressureRig& rig, double stress_kpa, double strain) {
    const double thin_wall = rig.thickness_mm / rig.shape.radius_mm;
    switch (rig.stress) {
        case RigStress::hoop: return stress_kpa * thin_wall / (1.0 + strain);
        case RigStress::nominal: return stress_kpa * thin_wall;
        case RigStress::paper: break;
    }
    return stress_kpa;
}

void set_load(Tube& tube, const PressureRig& rig, double traction_kpa) {
    for (std::size_t i = 0; i < tube.area_mm2.size(); ++i) {
        const Vec3 radial = radial_part(tube.wall->rest[i], rig.shape);
        tube.load->load[i] = traction_kpa * tube.area_mm2[i] / std::sqrt(radial.squaredNorm()) * radial;
    }
}

bool come_to_rest(Tube& tube, const PressureRig& rig, double stress_kpa, const std::function<bool()>& stop) {
    SoftBodyState& state = *tube.world->first<SoftBodyState>();
    const Input nothing;
    Channels channels;
    for (int look = 0; look < most_looks; ++look) {
        if (stop && stop()) return false;
        set_load(tube, rig, traction(rig, stress_kpa, mean_strain(tube, rig.shape, state.x)));
        const std::vector<Vec3> before = state.x;
        for (int k = 0; k < steps_a_look; ++k) {
            step(*tube.world, nothing, channels);
            for (Vec3& v : state.v) v *= velocity_kept;
        }
        const double moved = largest_move(state.x, before);
        if (std::isnan(moved)) return false;
        if (moved < still_mm) return true;
    }
    return false;
}

}  // namespace

PressureRig pressure_rig(const SceneSpec& scene) {
    const auto refuse = [&](const std::string& why) {
        return UserError(scene.anatomy.where, "a rig wants one straight vessel of one radius; " + why);
    };
    if (scene.anatomy.file.empty()) throw refuse("this anatomy is a mesh");
    const AnatomySpec anatomy = load_anatomy(scene.anatomy.file);
    if (anatomy.vessels.size() != 1)
        throw refuse(scene.anatomy.file + " has " + std::to_string(anatomy.vessels.size()) + " vessels");
    const VesselSpec& vessel = anatomy.vessels.front();
    const auto point = [&](std::size_t i) {
        return Vec3(vessel.points[i][0], vessel.points[i][1], vessel.points[i][2]);
    };
    PressureRig rig;
    rig.shape.start = point(0);
    const Vec3 way = point(vessel.points.size() - 1) - rig.shape.start;
    rig.shape.length_mm = std::sqrt(way.squaredNorm());
    rig.shape.axis = way / rig.shape.length_mm;
    rig.shape.radius_mm = vessel.points.front()[3];
    for (std::size_t i = 0; i < vessel.points.size(); ++i) {
        if (std::fabs(vessel.points[i][3] - rig.shape.radius_mm) > 1e-9) throw refuse("the radius of this one changes");
        if (radial_part(point(i), rig.shape).squaredNorm() > 1e-12) throw refuse("this one is bent");
    }
    if (rig.shape.length_mm < 3.0 * rig.shape.radius_mm)
        throw refuse("this one is shorter than three of its radii, and its held ends would be felt in the middle");
    for (const RegionSpec& region : anatomy.regions)
        if (region.name == vessel.region) rig.thickness_mm = region.wall_thickness_mm;
    return rig;
}

std::vector<double> pressure_strain(const PressureRig& rig, const SceneSpec& scene, std::span<const double> stress_kpa,
                                    const std::function<bool()>& stop) {
    for (const double s : stress_kpa)
        if (!std::isfinite(s) || s < 0.0) throw UserError("a stress must be 0 kPa or more, found " + std::to_string(s));
    Tube tube = build_tube(rig, scene);
    SoftBodyState& state = *tube.world->first<SoftBodyState>();

    std::vector<double> out;
    // Rests so far, the last two of them with their stress: the next one is looked for on the line through them.
    std::vector<Vec3> last = state.x, before_last;
    double last_stress = 0.0, before_last_stress = 0.0;
    for (const double stress : stress_kpa) {
        if (!before_last.empty() && last_stress != before_last_stress) {
            const double t = std::clamp((stress - last_stress) / (last_stress - before_last_stress), -2.0, 2.0);
            for (std::size_t i = 0; i < last.size(); ++i) state.x[i] = last[i] + t * (last[i] - before_last[i]);
        }
        if (!come_to_rest(tube, rig, stress, stop)) {
            out.resize(stress_kpa.size(), std::numeric_limits<double>::quiet_NaN());
            return out;
        }
        out.push_back(mean_strain(tube, rig.shape, state.x));
        before_last = std::move(last);
        before_last_stress = last_stress;
        last = state.x;
        last_stress = stress;
    }
    return out;
}

}  // namespace cathlab
