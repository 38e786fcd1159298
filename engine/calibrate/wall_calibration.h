// The wall's parameters from a curve of stress and strain: a swarm, then a local search, over named numbers of a scene.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "calibrate/named_parameters.h"
#include "calibrate/pressure_rig.h"
#include "optimise/swarm.h"
#include "scene/wall_parameters.h"

namespace cathlab {

struct StressStrain {
    std::vector<double> stress_kpa;  ///< hoop stress, >= 0, rising
    std::vector<double> strain;      ///< (r - r0) / r0
};

struct WallSearch {
    /// Which numbers are free, within [wall]: wall.cluster_stiffness, wall.cluster_spacing_mm, wall.cluster_radius_mm,
    /// wall.density_kg_m3.  Bounds by named_bound().
    std::vector<Bound> free;
    SceneSpec scene;  ///< the other numbers of [wall]
    PressureRig rig;
    SwarmOptions swarm;
    int polish_evaluations = 40;  ///< of the local search after the swarm; 0 = none
};

struct WallCalibration {
    std::vector<std::pair<std::string, double>> values;
    double rmse_first = 0.0;           ///< of strain, with the scene's own numbers
    double rmse = 0.0;                 ///< of strain, with the best
    std::vector<double> strain;        ///< of the rig with the best, one a row of the reference
    std::vector<double> best_history;  ///< of the swarm
    bool stopped = false;
    std::string overlay;  ///< TOML to lay over a scene
};

/// Root mean square of the difference of strains; infinity where the rig does not come to rest or cannot be built.
double strain_error(const StressStrain& reference, const PressureRig& rig, const WallParameters& wall);

/// Throws UserError for a reference of fewer than two rows, columns of unequal length, stress that does not rise,
/// numbers that are not finite, and for free numbers that do not change this rig.  Same result on any number of
/// threads.
WallCalibration calibrate_wall(const StressStrain& reference, const WallSearch& search);

}  // namespace cathlab
