#include "calibrate/rig_run.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>

#include "anatomy/model.h"
#include "calibrate/specimen.h"
#include "calibrate/stations.h"
#include "contact/lumen_surface.h"
#include "core/errors.h"
#include "scene/wall_parameters.h"
#include "softbody/binding.h"
#include "softbody/observe.h"
#include "softbody/solver.h"
#include "step/step.h"
#include "world/step_settings.h"

namespace cathlab {
namespace {

constexpr double step_s = 0.005;
constexpr double velocity_kept = 0.9;  // a step; bleeding moves no equilibrium
constexpr int steps_a_look = 5;
constexpr int steps_an_elastic_look = 20;  // longer than from one halt to the next sight of motion
constexpr int most_looks = 1000;
constexpr double most_strain = 4.0;  // a wall that is wider than this runs away
constexpr double trace_kpa_s_per_mm = 1e-6;
constexpr double still_mm = 4e-4;          // the fastest particle in a look: the strain is then right to 3e-5
constexpr double still_elastic_mm = 1e-3;  // in its longer look; the strain is then right to 2e-4
constexpr double still_even_mm = 2e-6;     // of a guided piece, which moves as a whole and slowly

/// The load as an effect of this one world: the step asks it where it asks every other.
class RigLoad final : public Effect {
public:
    void force(const EffectContext& /*context*/, std::span<Vec3> force) override {
        for (std::size_t i = 0; i < force.size(); ++i) force[i] += load[i];
    }
    std::vector<Vec3> load;  // mN
};

const EffectInfo& load_info() {
    static const EffectInfo info = [] {
        EffectInfo out;
        out.name = "rig_load";
        out.doc = "the load of a rig";
        out.hooks = hook_force;
        return out;
    }();
    return info;
}

struct LoadedWall {
    Specimen specimen;
    std::unique_ptr<World> world;
    RigLoad* load = nullptr;

    SoftBodyState& state() const { return *world->first<SoftBodyState>(); }
};

Shared<SoftBodyModel> build_wall(const Specimen& specimen, const SceneSpec& scene) {
    WallParameters parameters = wall_parameters(scene.wall);
    parameters.surrounding_kpa_per_mm = 0.0;
    if (parameters.form == WallForm::elastic) parameters.damping_per_s = 0.0;
    // A trace of what surrounds a wall moves no equilibrium, and keeps a piece that nothing holds where it is.
    const bool free = std::find(specimen.held.begin(), specimen.held.end(), 1) == specimen.held.end();
    parameters.surrounding_kpa_s_per_mm = free ? trace_kpa_s_per_mm : 0.0;
    parameters.regions = specimen.own;
    std::map<std::array<double, 3>, bool> held;
    const auto key = [](const Vec3& p) { return std::array{p.x(), p.y(), p.z()}; };
    for (std::size_t i = 0; i < specimen.held.size(); ++i)
        held[key(specimen.sample.position[i])] = specimen.held[i] != 0;
    return std::make_shared<const SoftBodyModel>(
        build_soft_body(specimen.sample, parameters, [&](const Vec3& p) { return held.at(key(p)); }));
}

// No device ever touches the surface; the step wants one, and one triangle is the cheapest.
Shared<LumenSurfaceModel> least_surface(const WallSample& sample) {
    const Triangle& t = sample.triangles.front();
    TriMesh mesh;
    PointBinding binding;
    for (int k = 0; k < 3; ++k) {
        mesh.vertices.push_back(sample.position[static_cast<std::size_t>(t[k])]);
        binding.start.push_back(k);
        binding.particle.push_back(t[k]);
        binding.weight.push_back(1.0);
    }
    binding.start.push_back(3);
    mesh.triangles.emplace_back(0, 1, 2);
    return std::make_shared<const LumenSurfaceModel>(build_lumen_surface(mesh, {}, {}, std::move(binding)));
}

LoadedWall build(const WallRig& rig, const SceneSpec& scene) {
    LoadedWall out;
    out.specimen = make_specimen(rig, scene.wall);
    if (out.specimen.sample.triangles.empty())
        throw UserError("the rig's wall has room for no more than a few particles; [wall] particle_spacing_mm is " +
                        std::to_string(scene.wall.particle_spacing_mm));
    const Shared<SoftBodyModel> wall = build_wall(out.specimen, scene);
    auto anatomy = std::make_shared<AnatomyModel>();
    anatomy->name = std::string(rig_name(rig.kind));
    anatomy->regions.emplace_back();
    if (rig.stations) anatomy->regions = rig.stations->regions;

    out.world = std::make_unique<World>(rig.seed, Workers(1));
    StepSettings settings;
    settings.dt = step_s;
    settings.substeps = 1;
    settings.iterations = scene.step.iterations;
    out.world->add(out.world->create(world_entity), settings);
    const Entity vessel = out.world->create(vessel_entity);
    out.world->add(vessel, Shared<AnatomyModel>(std::move(anatomy)));
    out.world->add(vessel, wall);
    out.world->add(vessel, least_surface(out.specimen.sample));
    out.world->add(vessel, rest_state(*wall));
    const auto add_effect = [&](const EffectInfo& info, std::unique_ptr<Effect> effect) {
        out.world->add(out.world->create("effect." + std::string(info.name)), ActiveEffect{&info, std::move(effect)});
    };
    for (const SceneEffect& effect : scene.effects)
        if (effect.enabled && makes_the_wall(*effect.info)) add_effect(*effect.info, effect.info->make(effect.values));
    auto load = std::make_unique<RigLoad>();
    load->load.assign(wall->size(), Vec3::Zero());
    out.load = load.get();
    add_effect(load_info(), std::move(load));
    return out;
}

double largest_move(std::span<const Vec3> a, std::span<const Vec3> b) {
    double squared = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        const double moved = (a[i] - b[i]).squaredNorm();
        if (!(moved <= squared)) squared = moved;  // NaN is kept and never still
    }
    return std::sqrt(squared);
}

/// The loads that go with a stress: by the section at rest, at the strain that each gauge shows now.
void set_load(LoadedWall& wall, RigStress stress, double stress_kpa) {
    std::vector<Vec3>& load = wall.load->load;
    std::fill(load.begin(), load.end(), Vec3::Zero());
    for (const Gauge& gauge : wall.specimen.gauges) {
        const double at_rest =
            stress == RigStress::hoop ? stress_kpa / (1.0 + gauge.strain(wall.state().x)) : stress_kpa;
        for (std::size_t i = 0; i < load.size(); ++i) load[i] += at_rest * gauge.push[i];
    }
}

double widest(const LoadedWall& wall) {
    double strain = 0.0;
    for (const Gauge& gauge : wall.specimen.gauges) strain = std::max(strain, gauge.strain(wall.state().x));
    return strain;
}

/// Whether the wall as a whole slows down: it has passed an equilibrium on some way.  Stopped there, and only there, an
/// elastic wall, whose slow shapes would creep if its speeds were bled, comes to rest soonest; it moves no equilibrium.
class Pace {
public:
    bool slows(const SoftBodyModel& wall, const SoftBodyState& state) {
        const double energy = kinetic_energy(wall, state);
        const bool slower = energy < last_;
        last_ = slower ? 0.0 : energy;
        return slower;
    }

private:
    double last_ = 0.0;
};

/// Takes energy out between two steps: speeds are bled, and a particle that turns back has passed its place and is
/// stopped.  Neither moves an equilibrium, and the second ends what would swing from step to step.
void bleed(std::span<Vec3> v, std::vector<Vec3>& last) {
    last.resize(v.size(), Vec3::Zero());
    for (std::size_t i = 0; i < v.size(); ++i) {
        if (v[i].dot(last[i]) < 0.0) v[i].setZero();
        v[i] *= velocity_kept;
        last[i] = v[i];
    }
}

bool come_to_rest(LoadedWall& wall, RigStress stress, double stress_kpa, const std::function<bool()>& stop) {
    SoftBodyState& state = wall.state();
    const Input nothing;
    Channels channels;
    std::vector<Vec3> last_speed;
    const SoftBodyModel& model = **wall.world->first<Shared<SoftBodyModel>>();
    const bool elastic = model.form == WallForm::elastic;
    const double still = wall.specimen.guide ? still_even_mm : elastic ? still_elastic_mm : still_mm;
    Pace pace;
    for (int look = 0; look < most_looks; ++look) {
        if (stop && stop()) return false;
        set_load(wall, stress, stress_kpa);
        const std::vector<Vec3> before = state.x;
        for (int k = 0; k < (elastic ? steps_an_elastic_look : steps_a_look); ++k) {
            step(*wall.world, nothing, channels);
            if (!elastic)
                bleed(state.v, last_speed);
            else if (pace.slows(model, state))
                state.v.assign(state.v.size(), Vec3::Zero());
            if (wall.specimen.guide) wall.specimen.guide(state.x, state.v);
        }
        const double moved = largest_move(state.x, before);
        if (std::isnan(moved) || widest(wall) > most_strain) return false;
        if (moved < still) return true;
    }
    return false;
}

void check_stress(const WallRig& rig, double stress_kpa) {
    if (!std::isfinite(stress_kpa)) throw UserError("a stress is not finite");
    if (stress_kpa < 0.0 && rig.kind != RigKind::block)
        throw UserError("a stress must be 0 kPa or more, found " + std::to_string(stress_kpa) +
                        "; under compression a thin " + std::string(rig_name(rig.kind)) +
                        " folds at once, and a rig of kind block alone does not");
}

}  // namespace

bool makes_the_wall(const EffectInfo& info) {
    constexpr unsigned wall = hook_material | hook_constraint | hook_force | hook_membrane | hook_slip;
    return (info.hooks & wall) != 0 && (info.hooks & ~wall) == 0;
}

std::vector<std::vector<double>> rig_strain(const WallRig& rig, const SceneSpec& scene,
                                            std::span<const double> stress_kpa, const std::function<bool()>& stop) {
    for (const double stress : stress_kpa) check_stress(rig, stress);
    LoadedWall wall = build(rig, scene);
    SoftBodyState& state = wall.state();
    const std::size_t gauges = wall.specimen.gauges.size();

    std::vector<std::vector<double>> out(gauges);
    // Rests so far, the last two of them with their stress: the next one is looked for on the line through them.
    std::vector<Vec3> last = state.x, before_last;
    double last_stress = 0.0, before_last_stress = 0.0;
    for (const double stress : stress_kpa) {
        if (!before_last.empty() && last_stress != before_last_stress) {
            const double t = std::clamp((stress - last_stress) / (last_stress - before_last_stress), -2.0, 2.0);
            for (std::size_t i = 0; i < last.size(); ++i) state.x[i] = last[i] + t * (last[i] - before_last[i]);
        }
        if (!come_to_rest(wall, rig.stress, stress, stop)) {
            for (std::vector<double>& curve : out)
                curve.resize(stress_kpa.size(), std::numeric_limits<double>::quiet_NaN());
            return out;
        }
        for (std::size_t g = 0; g < gauges; ++g) out[g].push_back(wall.specimen.gauges[g].strain(state.x));
        before_last = std::move(last);
        before_last_stress = last_stress;
        last = state.x;
        last_stress = stress;
    }
    return out;
}

std::vector<std::string> gauge_names(const WallRig& rig) {
    if (rig.kind != RigKind::stations) return {std::string(rig_name(rig.kind))};
    std::vector<std::string> out;
    for (const Station& station : rig.stations->stations) out.push_back(station.name);
    return out;
}

}  // namespace cathlab
