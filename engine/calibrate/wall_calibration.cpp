#include "calibrate/wall_calibration.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/errors.h"
#include "optimise/local.h"

namespace cathlab {
namespace {

void check_reference(const StressStrain& reference) {
    const auto& stress = reference.stress_kpa;
    if (stress.size() != reference.strain.size()) throw UserError("the reference's columns are not of one length");
    if (stress.size() < 2)
        throw UserError("the reference has " + std::to_string(stress.size()) + " rows; at least 2 are wanted");
    for (std::size_t i = 0; i < stress.size(); ++i) {
        const std::string row = "row " + std::to_string(i + 1) + " of the reference: ";
        if (!std::isfinite(stress[i]) || !std::isfinite(reference.strain[i]))
            throw UserError(row + "a number is not finite");
        if (stress[i] < 0.0) throw UserError(row + "stress " + std::to_string(stress[i]) + " kPa; 0 or more is wanted");
        if (i > 0 && stress[i] <= stress[i - 1])
            throw UserError(row + "stress " + std::to_string(stress[i]) + " kPa does not rise");
    }
}

void check_free(const std::vector<Bound>& free) {
    const std::vector<std::string> known{"wall.cluster_stiffness", "wall.cluster_spacing_mm", "wall.cluster_radius_mm",
                                         "wall.density_kg_m3"};
    if (free.empty()) throw UserError("no parameter was named; for this rig: " + comma_list(known));
    for (const Bound& bound : free) {
        if (std::find(known.begin(), known.end(), bound.name) == known.end())
            throw UserError("'" + bound.name + "' does not change a tube under pressure; what does: " +
                            comma_list(known) + did_you_mean(bound.name, known));
        named_bound(bound.name, bound.lower, bound.upper);
    }
}

}  // namespace

double strain_error(const StressStrain& reference, const PressureRig& rig, const WallParameters& wall) {
    double sum = 0.0;
    try {
        const std::vector<double> strain = pressure_strain(rig, wall, reference.stress_kpa);
        for (std::size_t i = 0; i < strain.size(); ++i)
            sum += (strain[i] - reference.strain[i]) * (strain[i] - reference.strain[i]);
    } catch (const UserError&) {
        return std::numeric_limits<double>::infinity();  // clusters that leave a particle alone: a bad place of the
                                                         // range
    }
    const double error = std::sqrt(sum / static_cast<double>(reference.strain.size()));
    return std::isfinite(error) ? error : std::numeric_limits<double>::infinity();
}

WallCalibration calibrate_wall(const StressStrain& reference, const WallSearch& search) {
    check_reference(reference);
    check_free(search.free);
    Problem problem;
    problem.bounds = search.free;
    for (const Bound& bound : search.free)
        problem.start.push_back(std::clamp(get_named(search.scene, bound.name), bound.lower, bound.upper));
    const auto wall_at = [&](std::span<const double> x) {
        SceneSpec scene = search.scene;
        for (std::size_t k = 0; k < x.size(); ++k) set_named(scene, search.free[k].name, x[k]);
        return wall_parameters(scene.wall);
    };
    problem.objective = [&](std::span<const double> x) { return strain_error(reference, search.rig, wall_at(x)); };

    WallCalibration out;
    out.rmse_first = strain_error(reference, search.rig, wall_parameters(search.scene.wall));
    Result best = minimise_swarm(problem, search.swarm);
    out.best_history = best.best_history;
    out.stopped = best.stopped;
    if (best.best.empty()) throw UserError("the tube did not come to rest anywhere in the ranges given");
    if (search.polish_evaluations > 0 && !best.stopped) {
        problem.start = best.best;
        LocalOptions local;
        local.max_evaluations = search.polish_evaluations;
        local.first_step = 0.05;
        local.x_tolerance = 1e-5;
        local.method = LocalMethod::sbplx;
        const Result polished = minimise_local(problem, local);
        if (polished.value < best.value) best = polished;
    }
    std::vector<std::string> paths;
    for (std::size_t k = 0; k < best.best.size(); ++k) {
        paths.push_back(search.free[k].name);
        out.values.emplace_back(search.free[k].name, best.best[k]);
    }
    out.rmse = best.value;
    out.strain = pressure_strain(search.rig, wall_at(best.best), reference.stress_kpa);
    out.overlay = overlay_text(paths, best.best);
    return out;
}

}  // namespace cathlab
