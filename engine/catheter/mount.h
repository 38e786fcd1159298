// Where the catheter enters and what its shaft follows; what a wire is guided by.
#pragma once

#include <vector>

#include "core/types.h"

namespace cathlab {

/// Component of the catheter's entity; const after load.
struct CatheterMount {
    Pose mouth;                ///< of the sheath, world, z into the vessel
    Index entry = 0;           ///< node of the centre-line graph at the mouth
    bool follow_wire = false;  ///< the shaft follows the guidewire where that leads
};

/// Component of a wire that comes out of a guiding catheter engaged in an ostium, beside the WallPlace of its mouth:
/// the way that the catheter takes to there.  It is no body of its own: it holds the wire as a sheath does, and its
/// mouth goes along with the ostium.
struct GuidePath {
    std::vector<Vec3> points;  ///< from the mouth back to where it enters
};

}  // namespace cathlab
