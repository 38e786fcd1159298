// A soft tube that is pushed outwards: the way in which an artery's stress and strain are measured [li2025, eqs. 1-4].
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "scene/scene_spec.h"
#include "softbody/tube.h"

namespace cathlab {

/// What the stress of a reference is taken for.  The wall keeps its volume, and both ends of the tube are held, so that
/// the thickness under load is t = t0 / (1 + epsilon) and the radius r = r0 (1 + epsilon).
enum class RigStress {
    hoop,     ///< the true stress in the wall, on its section under load: a pressure p = sigma t / r (thin wall)
    nominal,  ///< the same force on the section at rest: F / A0 = sigma t0 / r0
    paper     ///< sigma = F / A of [li2025] as it stands: a radial traction, r0 / t0 times as much
};

/// Both ends are held; there is no device, no heart, and nothing around the tube.
struct PressureRig {
    TubeShape shape{.radius_mm = 12.0, .length_mm = 80.0, .edge_mm = 1.0, .closed = false};
    double thickness_mm = 1.0;
    RigStress stress = RigStress::hoop;
    std::uint64_t seed = 1;
};

/// The tube of a scene: one straight vessel of one radius in a parametric anatomy, with its region's thickness.
/// Throws UserError for any other anatomy.
PressureRig pressure_rig(const SceneSpec& scene);

/// Mean radial strain (r - r0) / r0 of the middle third of the tube at each stress, r = |x - x_c| with x_c on the axis
/// [li2025, eq. 4].  The load is a force a particle along the radius at rest, by the area A0 at rest: for the true
/// stress F / A0 = p (1 + epsilon) = sigma t0 / (r0 (1 + epsilon)), with epsilon as it is found.
///   scene        gives [wall] and the effects: the tube is a world of its own and is stepped as any other, so that
///                whatever makes the wall in a run makes it here.  [step] is not the scene's: the answer is a rest.
///   stress_kpa   each >= 0 and finite; solved in the order given, each from the ones before
///   stop         asked now and then; true = give up, the rest is NaN
/// Static: velocities are bled until the wall stands still.  NaN where it does not come to rest.  Throws UserError for
/// wall parameters that cannot be.
std::vector<double> pressure_strain(const PressureRig& rig, const SceneSpec& scene, std::span<const double> stress_kpa,
                                    const std::function<bool()>& stop = {});

}  // namespace cathlab
