// An account of how well devices stay inside, independent of the rows, their margins and their memory.
#pragma once

#include <span>

#include "contact/lumen_surface.h"
#include "contact/rows.h"
#include "core/parallel.h"

namespace cathlab {

struct PenetrationReport {
    double deepest_mm = 0.0;  ///< largest depth of a sample's sphere beyond the surface: radius - signed distance, >= 0
    Index deepest_sample = -1;      ///< -1 = none penetrates
    double least_clearance_mm = 0;  ///< smallest signed distance of a centre, positive inside (0 without samples)
    Index outside = 0;              ///< centres outside the lumen by more than their own radius
};

/// Searches the whole surface for every sample, without a hint: a sample that slipped into a neighbouring vessel counts
/// as inside, one between two vessels as outside.  Throws std::logic_error for samples that are not finite.
PenetrationReport penetration_report(const LumenSurfaceModel& model, const LumenSurfaceState& state,
                                     std::span<const DeviceSample> samples, const Workers& workers);

}  // namespace cathlab
