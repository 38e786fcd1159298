// A soft tube under inner pressure: the ordinary way in which an artery's stress and strain are measured.
#pragma once

#include <span>
#include <vector>

#include "softbody/model.h"
#include "softbody/tube.h"

namespace cathlab {

struct PressureRig {
    TubeShape shape{.radius_mm = 8.0, .length_mm = 36.0, .edge_mm = 0.7};
    double particle_spacing_mm = 2.1;
    double thickness_mm = 1.0;
    std::uint64_t seed = 1;
};

/// Mean radial strain (r - r0) / r0 of the middle third of the tube at each hoop stress, with both ends held.
/// The pressure that goes with a hoop stress is p = sigma t / r0 (thin wall, at the shape without load).
///   stress_kpa   each >= 0 and finite; solved in the order given, each from the one before
/// Static: velocities are bled until the wall stands still (a particle moves by less than 1e-5 mm in 25 steps).
/// NaN where it does not come to rest.  Throws UserError for wall parameters that cannot be.
std::vector<double> pressure_strain(const PressureRig& rig, const WallParameters& wall,
                                    std::span<const double> stress_kpa);

}  // namespace cathlab
