// A uniform piece of elastic wall pulled (or pressed) one way, its width and thickness free: strip, block and ring with
// free edges in closed form.  The same law as the solver's, asked at the one point that such a piece is.
#pragma once

#include <Eigen/Core>
#include <functional>

#include "softbody/membrane.h"

namespace cathlab {

struct Uniaxial {
    double along = 1.0, across = 1.0;  ///< stretches
    /// How the two forces go with the two stretches, as the last search left it (kPa; 0 = not known).
    Eigen::Matrix2d slope = Eigen::Matrix2d::Zero();
};

/// The stretches at which the force by the section at rest, S_11 along, is stress_kpa and S_22 is 0; `law` writes
/// point.stress at point.c and keeps nothing.  Newton's method from `from`, its slopes by Broyden's update of the last
/// ones [broyden1965] and anew where that is slow; where a law has corners, one stretch within the other.  False where
/// it does not get there.
bool uniaxial_rest(const std::function<void(MembranePoint&)>& law, double stiffness_kpa, double stress_kpa,
                   Uniaxial& from);

}  // namespace cathlab
