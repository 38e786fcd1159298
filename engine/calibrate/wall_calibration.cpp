#include "calibrate/wall_calibration.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/errors.h"
#include "optimise/local.h"

namespace cathlab {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

bool acts_on_wall(const EffectInfo& info) {
    return !info.for_tests && (info.hooks & (hook_material | hook_constraint | hook_force)) != 0;
}

void check_free(const std::vector<Bound>& free) {
    const std::vector<std::string> known = wall_paths();
    for (std::size_t i = 0; i < free.size(); ++i) {
        const Bound& bound = free[i];
        find_named_parameter(bound.name);  // a path that no scene has is told with the nearest that one has
        if (std::find(known.begin(), known.end(), bound.name) == known.end())
            throw UserError("'" + bound.name + "' does not change a tube under load; what does: " + comma_list(known) +
                            did_you_mean(bound.name, known));
        named_bound(bound.name, bound.lower, bound.upper);
        for (std::size_t k = 0; k < i; ++k)
            if (free[k].name == bound.name) throw UserError("'" + bound.name + "' is named twice");
    }
}

// The rig's strain at each row.  A recording of thousands of rows does not need as many rests: then the curve between
// forty of them is taken.
std::vector<double> strain_at_rows(const StressStrain& reference, const PressureRig& rig, const SceneSpec& scene,
                                   const std::function<bool()>& stop) {
    constexpr std::size_t most_levels = 60, levels_instead = 41;
    std::vector<double> levels = reference.stress_kpa;
    std::sort(levels.begin(), levels.end());
    levels.erase(std::unique(levels.begin(), levels.end()), levels.end());
    if (levels.size() > most_levels) {
        const double low = levels.front(), high = levels.back();
        levels.resize(levels_instead);
        for (std::size_t i = 0; i < levels_instead; ++i)
            levels[i] = low + (high - low) * static_cast<double>(i) / static_cast<double>(levels_instead - 1);
        levels.back() = high;
    }
    const std::vector<double> strain = pressure_strain(rig, scene, levels, stop);
    std::vector<double> out;
    for (const double stress : reference.stress_kpa) {
        const auto it = std::lower_bound(levels.begin(), levels.end(), stress);
        const auto above = static_cast<std::size_t>(it - levels.begin());
        const std::size_t below = above == 0 || levels[above] == stress ? above : above - 1;
        const double t = above == below ? 0.0 : (stress - levels[below]) / (levels[above] - levels[below]);
        out.push_back(strain[below] + t * (strain[above] - strain[below]));
    }
    return out;
}

void check_pushes(const StressStrain& reference) {
    for (std::size_t i = 0; i < reference.stress_kpa.size(); ++i)
        if (reference.stress_kpa[i] < 0.0)
            throw UserError({reference.file.empty() ? "the reference" : reference.file,
                             i < reference.line.size() ? reference.line[i] : 0, "stress"},
                            "found " + std::to_string(reference.stress_kpa[i]) +
                                " kPa; the rig stretches the wall, 0 or more is wanted");
}

std::vector<double> strain_or_nan(const StressStrain& reference, const WallSearch& search, const SceneSpec& scene) {
    try {
        return strain_at_rows(reference, search.rig, scene, search.stop);
    } catch (const UserError&) {
        return std::vector<double>(reference.strain.size(), std::numeric_limits<double>::quiet_NaN());
    }
}

// Where nothing worked the reason is that of the scene's own numbers, or of the middle of the bounds.
[[noreturn]] void tell_why(const WallSearch& search, const SceneSpec& scene) {
    pressure_strain(search.rig, scene, std::vector<double>{0.0});
    throw UserError("the tube came to rest nowhere in the ranges given: it is too soft for the reference's stress");
}

}  // namespace

std::vector<Bound> default_wall_bounds(RigStress stress) {
    const bool pushed_hard = stress == RigStress::paper;
    return {named_bound("wall.cluster_spacing_mm", 4.0, 14.0), named_bound("wall.cluster_radius_mm", 6.0, 24.0),
            named_bound("wall.cluster_stiffness", pushed_hard ? 0.8 : 0.3, pushed_hard ? 0.999 : 0.97)};
}

std::vector<std::string> wall_paths() {
    // What a tube at rest, with nothing around it and no device, does not feel.
    const std::vector<std::string> unfelt{"wall.damping_per_s", "wall.surrounding_kpa_per_mm",
                                          "wall.surrounding_kpa_s_per_mm", "wall.max_speed_mm_s", "wall.friction"};
    std::vector<std::string> out;
    for (const NamedParameter& named : named_parameters()) {
        if (named.path.starts_with("wall.") && std::find(unfelt.begin(), unfelt.end(), named.path) == unfelt.end())
            out.push_back(named.path);
        for (const EffectInfo& info : effect_table())
            if (acts_on_wall(info) && named.path.starts_with("effects." + std::string(info.name) + "."))
                out.push_back(named.path);
    }
    return out;
}

double strain_error(const StressStrain& reference, const PressureRig& rig, const SceneSpec& scene,
                    const std::function<bool()>& stop) {
    try {
        const double error = figures_of(strain_at_rows(reference, rig, scene, stop), reference.strain).rmse;
        return std::isfinite(error) ? error : infinite;
    } catch (const UserError&) {
        return infinite;  // clusters that leave a particle alone: a bad place of the range
    }
}

WallCalibration calibrate_wall(const StressStrain& reference, const WallSearch& wanted) {
    check(reference);
    check_pushes(reference);
    WallSearch search = wanted;
    if (search.free.empty()) search.free = default_wall_bounds(search.rig.stress);
    check_free(search.free);
    const auto scene_at = [&](std::span<const double> x) {
        SceneSpec scene = search.scene;
        for (std::size_t k = 0; k < x.size(); ++k) set_named(scene, search.free[k].name, x[k]);
        return scene;
    };
    Problem problem;
    problem.bounds = search.free;
    WallCalibration out;
    out.free = search.free;
    for (const Bound& bound : search.free) {
        const double now = get_named(search.scene, bound.name);
        out.first.emplace_back(bound.name, now);
        problem.start.push_back(std::clamp(now, bound.lower, bound.upper));
    }
    problem.objective = [&](std::span<const double> x) {
        return strain_error(reference, search.rig, scene_at(x), search.stop);
    };

    out.strain_first = strain_or_nan(reference, search, search.scene);
    out.figures_first = figures_of(out.strain_first, reference.strain);
    Result best = minimise_swarm(problem, search.swarm);
    out.best_history = best.best_history;
    out.stopped = best.stopped;
    out.evaluations = best.evaluations;
    if (best.best.empty()) {
        if (search.stop && search.stop()) throw UserError("stopped before anything was found");
        tell_why(search, scene_at(problem.start));
    }
    if (search.polish_evaluations > 0 && !best.stopped) {
        problem.start = best.best;
        LocalOptions local;
        local.max_evaluations = search.polish_evaluations;
        local.first_step = 0.05;
        local.x_tolerance = 1e-5;
        local.method = LocalMethod::sbplx;
        local.on_evaluation = [&](const SearchProgress& progress) {
            if (search.polish) search.polish(progress.evaluations);
            out.stopped = search.stop && search.stop();
            return !out.stopped;
        };
        const Result polished = minimise_local(problem, local);
        out.evaluations += polished.evaluations;
        if (polished.value < best.value) best = polished;
    }
    std::vector<std::string> paths;
    for (std::size_t k = 0; k < best.best.size(); ++k) {
        paths.push_back(search.free[k].name);
        out.values.emplace_back(search.free[k].name, best.best[k]);
    }
    out.strain = strain_at_rows(reference, search.rig, scene_at(best.best), {});
    out.figures = figures_of(out.strain, reference.strain);
    out.overlay = overlay_text(paths, best.best);
    return out;
}

}  // namespace cathlab
