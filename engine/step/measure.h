// The end of a step: exposure, dose and contrast go on, and every channel is written.
#pragma once

#include "core/channels.h"
#include "core/input.h"
#include "step/parts.h"
#include "step/substep.h"

namespace cathlab {

/// Moves the C-arm, steps exposure, dose and bolus: state of the world, whether or not anybody draws a picture.
void advance_imaging(Parts& parts, const Input& input, double dt);

/// Writes every channel and leaves events (refused commands, force over the limit).
void measure(Parts& parts, const Input& input, const StepSums& sums, Channels& channels);

}  // namespace cathlab
