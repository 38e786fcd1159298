// What the passes of a substep did not get out of the wall.
#pragma once

#include <span>

#include "contact/contact_set.h"
#include "step/parts.h"

namespace cathlab {

/// Moves the wall until no sample is much deeper in it than 0.2 mm, after velocities and forces are taken.  `deep`:
/// rows say that something is, or were never sure of their places; the wall is pushed out from where the passes left it
/// (contact/push_out.h).  Then every sample is looked after truly.  What is deep in the nearest wall for all that lies
/// behind a sheet of it that passed by unseen, or in a fold that lies the other way round: the wall there goes back to
/// where the substep began, at rest, and is pushed out from there; the devices have gone less than a millimetre since.
/// near: the surface that follows.
void take_out_of_wall(Parts& p, std::span<const DeviceSample> samples, const TreePart& near, bool deep);

}  // namespace cathlab
