// Where the catheter enters and what its shaft follows.
#pragma once

#include "core/types.h"

namespace cathlab {

/// Component of the catheter's entity; const after load.
struct CatheterMount {
    Pose mouth;                ///< of the sheath, world, z into the vessel
    Index entry = 0;           ///< node of the centre-line graph at the mouth
    bool follow_wire = false;  ///< the shaft follows the guidewire where that leads
};

}  // namespace cathlab
