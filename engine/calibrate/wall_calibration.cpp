#include "calibrate/wall_calibration.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/errors.h"
#include "optimise/least_squares.h"
#include "optimise/local.h"

namespace cathlab {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

void check_free(const std::vector<Bound>& free) {
    const std::vector<std::string> known = wall_paths();
    for (std::size_t i = 0; i < free.size(); ++i) {
        const Bound& bound = free[i];
        find_named_parameter(bound.name);  // a path that no scene has is told with the nearest that one has
        if (std::find(known.begin(), known.end(), bound.name) == known.end())
            throw UserError("'" + bound.name + "' does not change a wall under load; what does: " + comma_list(known) +
                            did_you_mean(bound.name, known));
        named_bound(bound.name, bound.lower, bound.upper);
        for (std::size_t k = 0; k < i; ++k)
            if (free[k].name == bound.name) throw UserError("'" + bound.name + "' is named twice");
    }
}

// Loads from rest outwards: those that press and those that pull are two ways.
std::vector<std::vector<double>> strain_at(const std::vector<double>& levels, const WallRig& rig,
                                           const SceneSpec& scene, const std::function<bool()>& stop) {
    const auto first_pull = std::lower_bound(levels.begin(), levels.end(), 0.0);
    std::vector<double> press(levels.begin(), first_pull);
    std::vector<double> pull(first_pull, levels.end());
    std::reverse(press.begin(), press.end());
    std::vector<std::vector<double>> out(gauge_names(rig).size());
    for (const auto* way : {&press, &pull}) {
        if (way->empty()) continue;
        const std::vector<std::vector<double>> strain = rig_strain(rig, scene, *way, stop);
        for (std::size_t g = 0; g < out.size(); ++g) {
            out[g].insert(out[g].end(), strain[g].begin(), strain[g].end());
            if (way == &press) std::reverse(out[g].begin(), out[g].end());
        }
    }
    return out;
}

// The rig's strain at each row, gauge by gauge.  A recording of thousands of rows does not need as many rests: then the
// curve between forty of them is taken.
std::vector<std::vector<double>> strain_at_rows(const StressStrain& reference, const WallRig& rig,
                                                const SceneSpec& scene, const std::function<bool()>& stop) {
    constexpr std::size_t most_levels = 60, levels_instead = 41;
    std::vector<double> levels = reference.stress_kpa;
    std::sort(levels.begin(), levels.end());
    levels.erase(std::unique(levels.begin(), levels.end()), levels.end());
    if (levels.size() > most_levels) {
        // As the rows lie: where a curve is flat they stand near to each other.
        std::vector<double> some;
        for (std::size_t i = 0; i < levels_instead; ++i)
            some.push_back(levels[i * (levels.size() - 1) / (levels_instead - 1)]);
        levels = std::move(some);
    }
    std::vector<std::vector<double>> out;
    for (const std::vector<double>& strain : strain_at(levels, rig, scene, stop)) {
        std::vector<double>& rows = out.emplace_back();
        for (const double stress : reference.stress_kpa) {
            const auto it = std::lower_bound(levels.begin(), levels.end(), stress);
            const auto above = static_cast<std::size_t>(it - levels.begin());
            const std::size_t below = above == 0 || levels[above] == stress ? above : above - 1;
            const double t = above == below ? 0.0 : (stress - levels[below]) / (levels[above] - levels[below]);
            rows.push_back(strain[below] + t * (strain[above] - strain[below]));
        }
    }
    return out;
}

std::vector<double> misses(const std::vector<std::vector<double>>& strain, const StressStrain& reference) {
    std::vector<double> out;
    for (const std::vector<double>& curve : strain)
        for (std::size_t i = 0; i < curve.size(); ++i) out.push_back(curve[i] - reference.strain[i]);
    return out;
}

std::vector<std::vector<double>> strain_or_nan(const StressStrain& reference, const WallSearch& search,
                                               const SceneSpec& scene) {
    try {
        return strain_at_rows(reference, search.rig, scene, search.stop);
    } catch (const UserError&) {
        return std::vector(gauge_names(search.rig).size(),
                           std::vector<double>(reference.strain.size(), std::numeric_limits<double>::quiet_NaN()));
    }
}

// Where nothing worked the reason is that of the scene's own numbers, or of the middle of the bounds.
[[noreturn]] void tell_why(const WallSearch& search, const SceneSpec& scene) {
    rig_strain(search.rig, scene, std::vector<double>{0.0});
    throw UserError("the " + std::string(rig_name(search.rig.kind)) +
                    " came to rest nowhere in the ranges given: it is too soft for the reference's stress");
}

bool stiffens(const SceneSpec& scene) {
    return std::any_of(scene.effects.begin(), scene.effects.end(),
                       [](const SceneEffect& effect) { return effect.enabled && effect.info->elastic_wall; });
}

/// The numbers found, and those that an elastic wall has beside them: laid over any scene they make this wall.
std::string whole_overlay(const SceneSpec& scene, std::vector<std::string> paths) {
    if (scene.wall.form == "elastic") {
        const auto add = [&](const std::string& path) {
            if (std::find(paths.begin(), paths.end(), path) == paths.end()) paths.push_back(path);
        };
        add("wall.young_kpa");
        add("wall.poisson");
        for (const SceneEffect& effect : scene.effects)
            for (const Parameter& parameter : effect.info->parameters)
                if (effect.enabled && effect.info->elastic_wall)
                    add("effects." + std::string(effect.info->name) + "." + std::string(parameter.key));
    }
    std::vector<double> values;
    for (const std::string& path : paths) values.push_back(get_named(scene, path));
    std::string text = overlay_text(paths, values);
    const std::string section = "[wall]\n";
    if (scene.wall.form == "elastic") text.insert(text.find(section) + section.size(), "form = \"elastic\"\n");
    return text;
}

/// An elastic wall's strain is a smooth function of its numbers, whose valleys are long and narrow: least squares go
/// along them where a simplex does not.  Differences are taken far enough apart not to see how exactly the rig comes to
/// rest.
Result polish_by_squares(const StressStrain& reference, const WallSearch& search, const Problem& problem,
                         const std::function<SceneSpec(std::span<const double>)>& scene_at,
                         const std::function<bool()>& go_on) {
    LeastSquaresProblem squares;
    squares.bounds = problem.bounds;
    squares.start = problem.start;
    squares.residuals = gauge_names(search.rig).size() * reference.strain.size();
    squares.residual = [&](std::span<const double> x, std::span<double> residual) {
        if (!go_on()) return false;
        try {
            const std::vector<double> miss =
                misses(strain_at_rows(reference, search.rig, scene_at(x), search.stop), reference);
            std::copy(miss.begin(), miss.end(), residual.begin());
            return std::all_of(miss.begin(), miss.end(), [](double m) { return std::isfinite(m); });
        } catch (const UserError&) {
            return false;
        }
    };
    LeastSquaresOptions options;
    options.max_iterations = std::max(1, search.polish_evaluations / (1 + static_cast<int>(problem.bounds.size())));
    options.step = 0.02;
    options.value_tolerance = 1e-3;
    Result found = minimise_squares(squares, options);
    found.value = std::sqrt(2.0 * found.value / static_cast<double>(squares.residuals));
    return found;
}

}  // namespace

std::vector<Bound> default_wall_bounds(const SceneSpec& scene, RigStress stress) {
    const bool pushed_hard = stress == RigStress::paper;
    if (scene.wall.form == "elastic" && stiffens(scene))
        return {named_bound("wall.young_kpa", pushed_hard ? 300.0 : 30.0, pushed_hard ? 2000.0 : 200.0),
                named_bound("effects.stiffening.fibre_kpa", pushed_hard ? 50.0 : 5.0, pushed_hard ? 500.0 : 50.0),
                named_bound("effects.stiffening.exponent", 0.3, 4.0)};
    if (scene.wall.form == "elastic")
        return {named_bound("wall.young_kpa", pushed_hard ? 500.0 : 50.0, pushed_hard ? 30000.0 : 3000.0)};
    return {named_bound("wall.cluster_spacing_mm", 4.0, 14.0), named_bound("wall.cluster_radius_mm", 6.0, 24.0),
            named_bound("wall.cluster_stiffness", pushed_hard ? 0.8 : 0.3, pushed_hard ? 0.999 : 0.97)};
}

std::vector<std::string> wall_paths() {
    // What a wall at rest, with nothing around it and no device, does not feel.
    const std::vector<std::string> unfelt{"wall.damping_per_s", "wall.surrounding_kpa_per_mm",
                                          "wall.surrounding_kpa_s_per_mm", "wall.max_speed_mm_s", "wall.friction"};
    std::vector<std::string> out;
    for (const NamedParameter& named : named_parameters()) {
        if (named.path.starts_with("wall.") && std::find(unfelt.begin(), unfelt.end(), named.path) == unfelt.end())
            out.push_back(named.path);
        for (const EffectInfo& info : effect_table())
            if (!info.for_tests && makes_the_wall(info) &&
                named.path.starts_with("effects." + std::string(info.name) + "."))
                out.push_back(named.path);
    }
    return out;
}

void check_against(const StressStrain& reference, const WallRig& rig) {
    check(rig);
    if (rig.kind == RigKind::block) return;
    for (std::size_t i = 0; i < reference.stress_kpa.size(); ++i)
        if (reference.stress_kpa[i] < 0.0)
            throw UserError(
                {reference.file.empty() ? "the reference" : reference.file,
                 i < reference.line.size() ? reference.line[i] : 0, "stress"},
                "found " + std::to_string(reference.stress_kpa[i]) + " kPa, a compression, under which a thin " +
                    (rig.round() ? "round wall" : "strip") +
                    " folds at once: 0 or more is wanted here, or a rig of kind block, which its guides keep "
                    "flat (--rig scenes/rigs/block.toml)");
}

double strain_error(const StressStrain& reference, const WallRig& rig, const SceneSpec& scene,
                    const std::function<bool()>& stop) {
    try {
        const double error = figures_of(misses(strain_at_rows(reference, rig, scene, stop), reference)).rmse;
        return std::isfinite(error) ? error : infinite;
    } catch (const UserError&) {
        return infinite;  // clusters that leave a particle alone: a bad place of the range
    }
}

WallCalibration calibrate_wall(const StressStrain& reference, const WallSearch& wanted) {
    check(reference);
    check_against(reference, wanted.rig);
    WallSearch search = wanted;
    if (search.free.empty()) search.free = default_wall_bounds(search.scene, search.rig.stress);
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

    const auto first = strain_or_nan(reference, search, search.scene);
    out.figures_first = figures_of(misses(first, reference));
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
        int told = 0;
        const auto tell = [&](int done) {
            if (search.polish) search.polish(done);
            out.stopped = search.stop && search.stop();
            return !out.stopped;
        };
        Result polished;
        if (search.scene.wall.form == "elastic") {
            const auto one_more = [&] { return tell(++told); };
            polished = polish_by_squares(reference, search, problem, scene_at, one_more);
        } else {
            LocalOptions local;
            local.max_evaluations = search.polish_evaluations;
            local.first_step = 0.05;
            local.x_tolerance = 1e-5;
            local.method = LocalMethod::sbplx;
            local.on_evaluation = [&](const SearchProgress& progress) { return tell(progress.evaluations); };
            polished = minimise_local(problem, local);
        }
        out.evaluations += polished.evaluations;
        if (polished.value < best.value) best = polished;
    }
    std::vector<std::string> paths;
    for (std::size_t k = 0; k < best.best.size(); ++k) {
        paths.push_back(search.free[k].name);
        out.values.emplace_back(search.free[k].name, best.best[k]);
    }
    const auto strain = strain_at_rows(reference, search.rig, scene_at(best.best), {});
    out.figures = figures_of(misses(strain, reference));
    const std::vector<std::string> names = gauge_names(search.rig);
    for (std::size_t g = 0; g < names.size(); ++g)
        out.gauges.push_back({names[g], first[g], strain[g], figures_of(first[g], reference.strain),
                              figures_of(strain[g], reference.strain)});
    out.overlay = whole_overlay(scene_at(best.best), paths);
    return out;
}

}  // namespace cathlab
