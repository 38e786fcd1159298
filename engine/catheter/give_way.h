// A catheter that is pushed harder than it can hold gives way.
#pragma once

#include <span>

#include "catheter/shape.h"

namespace cathlab {

/// What the wall does to one sample of the catheter.
struct WallPush {
    Index point = 0;            ///< index into the pose's points
    Vec3 force = Vec3::Zero();  ///< on the catheter, mN
};

/// The motion by which the catheter yields to the wall within h seconds, as a command: cables, shaft and drive are no
/// rigid bodies, they slip where the load exceeds the force limit.  Along every axis q (advance, rotation and the two
/// components of each segment's bend) the load is the generalised force Q = sum of force . dp/dq, and the axes yield in
/// proportion to r^2 Q, r the axis' own top rate, so that the whole motion runs at `share` (0 to 1) of the top rates
/// and the wall's work on it is positive.  The shaft gives way backwards only.  Not loaded: the command stays put.
CatheterCommand give_way(const CatheterSpec& spec, const CatheterState& state, const Rail& rail,
                         const CatheterShape& now, std::span<const WallPush> pushes, double share, double h);

}  // namespace cathlab
