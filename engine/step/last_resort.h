// What the passes of a substep did not get out of the wall.
#pragma once

#include <span>

#include "contact/contact_set.h"
#include "step/parts.h"

namespace cathlab {

/// Moves the wall until no sample is much deeper in it than 0.2 mm, after velocities and forces are taken.  First from
/// where the passes left it (contact/push_out.h).  Where that does not do, because the wall was folded over a device
/// and a sheet of it lies the other way round, the wall there goes back to where the substep began, at rest: all was
/// inside then, and the devices have gone less than a millimetre since.  near: the surface that follows.
void take_out_of_wall(Parts& p, std::span<const DeviceSample> samples, const TreePart& near);

}  // namespace cathlab
