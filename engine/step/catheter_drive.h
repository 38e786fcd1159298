// The catheter in a substep: the rail that its shaft is laid on, and what is taken of its command.
#pragma once

#include "contact/inside_catheter.h"
#include "core/input.h"
#include "step/actuation.h"
#include "step/parts.h"

namespace cathlab {

/// Takes of the catheter's command what the wall allows and moves it.  Returns the refused part, 0 to 1.
double move_catheter(Parts& parts, const Input& input, const SegmentBends& bends, double h);

/// Lays the catheter where a run begins: straight segments where they fit, else bent along the vessel, and where they
/// do not fit so either, drawn back to where they do (an event tells).
void settle_catheter(Parts& parts);

/// Whether the wire runs in the catheter: that has a lumen, and both come out of one sheath.
bool wire_inside(const Parts& parts);

/// The bore of the catheter for the wire inside it; empty where there is no catheter.
CatheterBore catheter_bore(const Parts& parts);

}  // namespace cathlab
