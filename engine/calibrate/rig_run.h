// A rig under load: a world of its own, stepped until it stands still.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "calibrate/wall_rig.h"
#include "effects/effect.h"

namespace cathlab {

/// Whether an effect makes the wall itself and moves nothing: those alone act on a rig.
bool makes_the_wall(const EffectInfo& info);

/// Strain at each gauge of the rig (a tube has one, stations one each) under each stress.
///   scene        gives [wall] and the effects that make the wall: the rig is a world of its own and is stepped as any
///                other, so that whatever makes the wall in a run makes it here.  Heart, devices, respiration and what
///                surrounds the vessels are left out.  [step] is not the scene's: the answer is a rest
///   stress_kpa   finite; below 0 for a block alone; solved in the order given, each from the ones before
///   stop         asked now and then; true = give up, the rest is NaN
/// Returns [gauge][stress].  Static: velocities are bled until the wall stands still.  NaN where it does not come to
/// rest.  Throws UserError for wall parameters, a rig or a stress that cannot be.
std::vector<std::vector<double>> rig_strain(const WallRig& rig, const SceneSpec& scene,
                                            std::span<const double> stress_kpa, const std::function<bool()>& stop = {});

/// Names of the gauges, in that order.
std::vector<std::string> gauge_names(const WallRig& rig);

}  // namespace cathlab
