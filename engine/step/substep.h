// One substep: predict, detect contacts, repeat { clusters; chain; rows }, velocities, forces.
#pragma once

#include <optional>
#include <vector>

#include "core/input.h"
#include "step/actuation.h"
#include "step/parts.h"

namespace cathlab {

/// What the substeps of one step add up to.
struct StepSums {
    int substeps = 0;
    double wire_mn = 0.0, wire_tip_mn = 0.0, wire_sheath_mn = 0.0;  ///< sums over substeps
    double catheter_mn = 0.0, catheter_tip_mn = 0.0;
    Index wire_contacts = 0, catheter_contacts = 0;                   ///< in the last substep
    double wire_penetration_mm = 0.0, catheter_penetration_mm = 0.0;  ///< largest
    double catheter_refused = 0.0;                                    ///< largest
    double wire_refused_mm = 0.0;                                     ///< sum, signed as the command
    double imbalance = 0.0;                                           ///< largest
    Index tip_region = -1;  ///< of the wall contact nearest to a tip that carries force; -1 = no tip in contact
    Index tip_device = -1;
    std::optional<TreePart> surface_near;  ///< what the lumen surface's later updates in this step are about
};

/// Advances everything by h.  `time_s`: at the beginning; `s0`, `s1`: the part of the step that the substep covers, 0
/// to 1, along which the supports move from `support_before` to `support_after` (displacements of fixed particles, mm).
void substep(Parts& parts, const Input& input, const SegmentBends& bends, const Drive& drive,
             std::span<const Vec3> support_before, std::span<const Vec3> support_after, double s1, double time_s,
             double h, StepSums& sums);

}  // namespace cathlab
