// Contacts measured, or computed by finite elements, beside what the wall of the same material does: nothing is fitted.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "calibrate/figures.h"
#include "core/parallel.h"
#include "softbody/push_rig.h"

namespace cathlab {

/// One contact: the push, and what was measured of it.
struct MeasuredPush {
    std::string name;
    Push push;                     ///< its samples
    std::vector<Vec3> marker_mm;   ///< (samples) where the marker on the wall was
    std::vector<double> force_mn;  ///< (samples) along the push; empty = not recorded
};

struct PushComparison {
    std::string name;
    double moved_mm = 0.0, measured_mm = 0.0;        ///< of the marker at the farthest place of the ball
    double force_mn = 0.0, measured_force_mn = 0.0;  ///< there; 0 where it was not recorded
    double largest_miss_mm = 0.0;                    ///< of the marker's place, over the samples
};

struct ContactComparison {
    std::vector<PushComparison> pushes;
    Figures displacement;        ///< mm: how far the marker moved, simulated less measured, over all samples
    double place_rmse_mm = 0.0;  ///< of the marker's place in space
    double pearson = 0.0;        ///< of the two displacements
    double force_rms = 0.0;      ///< of (simulated - measured) / largest measured of the push; NaN where not recorded
    double worst_force = 0.0;    ///< largest |simulated / measured - 1| at the farthest places; NaN where not recorded
    std::vector<double> moved_mm, measured_mm;  ///< all samples, for a plot
};

/// Solves all pushes, several at the same time; the result does not depend on the number of threads.
/// on_sample is called before each sample from any thread; false = stop.
/// Throws UserError: a rig that cannot be built, a push without samples, a push that does not come to rest (which one,
/// at which sample), stopped.
ContactComparison compare_contacts(const PushRig& rig, const std::vector<MeasuredPush>& pushes, const Workers& workers,
                                   const std::function<bool()>& on_sample = {});

}  // namespace cathlab
