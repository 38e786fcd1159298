// The force bar: one number that tells the operator how hard the device presses.
#pragma once

#include <vector>

#include "core/archive.h"

namespace cathlab {

/// Rule of Li et al., section 2.1.5: the collision force along the whole shaft, counted only while the tip touches the
/// wall, mean-filtered, over the largest force allowed in the tip's region.
struct ForceBar {
    std::vector<double> window_mn;  ///< the last forces, a ring
    std::int64_t next = 0;          ///< where the next one goes
    double limit_n = 0.8;           ///< of the region where the tip last was

    /// filter_s: length of the mean filter, >= dt; dt: step length, s.
    static ForceBar with_filter(double filter_s, double dt);

    /// Adds one step's force in mN (0 while no tip is in contact) and returns the filtered force in N.
    double add(double shaft_force_mn);
};

inline void visit(Archive& archive, ForceBar& bar) {
    archive.field("window_mn", bar.window_mn);
    archive.field("next", bar.next);
    archive.field("limit_n", bar.limit_n);
}

}  // namespace cathlab
