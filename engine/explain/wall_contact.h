// The rig that a data set of kind wall-contact was measured on.
#pragma once

#include "explain/dataset.h"
#include "softbody/push_rig.h"

namespace cathlab {

/// The lumen (a tube or the set's mesh), its material, what holds it, the ball.  spacing_mm: of the wall's particles.
/// Throws UserError for a mesh that cannot be read.
PushRig push_rig_of(const WallContactSetup& setup, double spacing_mm);

}  // namespace cathlab
