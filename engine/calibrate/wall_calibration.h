// The wall's parameters from a curve of stress and strain: a swarm, then a local search, over named numbers of a scene.
#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "calibrate/figures.h"
#include "calibrate/named_parameters.h"
#include "calibrate/reference.h"
#include "calibrate/rig_run.h"
#include "optimise/swarm.h"

namespace cathlab {

/// Everything that a search is asked; the defaults are those of `cathlab calibrate wall`.
struct WallSearch {
    /// Which numbers are free, with bounds by named_bound(); empty = default_wall_bounds().
    std::vector<Bound> free;
    SceneSpec scene;  ///< the other numbers of [wall] and the effects
    WallRig rig;
    SwarmOptions swarm;
    int polish_evaluations = 30;           ///< of the local search after the swarm; 0 = none
    std::function<bool()> stop;            ///< asked while the rig runs; true = end soon with the best so far
    std::function<void(int done)> polish;  ///< told after each evaluation of the local search
};

/// What one gauge of the rig shows beside the reference.
struct GaugeCurve {
    std::string name;
    std::vector<double> strain_first, strain;  ///< one a row of the reference
    Figures figures_first, figures;            ///< of strain; NaN where the rig does not come to rest
};

struct WallCalibration {
    std::vector<Bound> free;
    std::vector<std::pair<std::string, double>> first, values;  ///< of the scene, and the best
    std::vector<GaugeCurve> gauges;                             ///< a tube has one, stations one each
    Figures figures_first, figures;                             ///< of strain, over all gauges alike
    std::vector<double> best_history;                           ///< RMSE after each generation of the swarm
    int evaluations = 0;
    bool stopped = false;
    std::string overlay;  ///< TOML to lay over a scene
};

/// Clusters: s_c 4 to 14 mm, r_c 6 to 24 mm, t_c 0.3 to 0.97, round the best values of [li2025] (8 mm, 12 mm, 0.8).
/// Elastic form: Young's modulus 50 to 3000 kPa; with the effect stiffening 30 to 200 kPa, its fibres 5 to 50 kPa,
/// exponent 0.3 to 4.  Under the paper's traction, which stresses the wall r0 / t0 times as much, t_c 0.8 to 0.999 and
/// ten times the moduli.
std::vector<Bound> default_wall_bounds(const SceneSpec& scene, RigStress stress);

/// Paths that change a wall under load: numbers of [wall] and of the effects that act on a wall by itself.
std::vector<std::string> wall_paths();

/// Throws UserError where the rig cannot be given the reference's stress: compression of what is thin and not guided
/// (file and line of the row), the paper's stress of what is not round.
void check_against(const StressStrain& reference, const WallRig& rig);

/// Root mean square of the difference of strains, over rows and gauges alike; infinity where the rig does not come to
/// rest or cannot be built.
double strain_error(const StressStrain& reference, const WallRig& rig, const SceneSpec& scene,
                    const std::function<bool()>& stop = {});

/// Throws UserError for a bad reference (check(), reference.h; check_against()), for free numbers that do not change
/// this rig, and where nothing within the bounds can be built or comes to rest (with what was said of the first place
/// tried).  Same result on any number of threads.
WallCalibration calibrate_wall(const StressStrain& reference, const WallSearch& search);

}  // namespace cathlab
