// The piece of wall that stations stand on: where a point stands by a station, and what is cut out of an anatomy.
#pragma once

#include "calibrate/stations.h"

namespace cathlab {

/// Where a point stands by a station: along its path, and across.
struct Foot {
    double arc = 0.0, across = 0.0;
    Vec3 centre = Vec3::Zero(), direction = Vec3::UnitZ();
    bool beyond = false;  // of the path's ends
};
Foot foot_on(const Station& station, const Vec3& p);

/// Fills mesh, region and radius of a wall whose stations are known: the fine surface near them, as far as it hangs
/// together with theirs.  Throws UserError where a station has no wall near its centre-line.
void cut_piece(const AnatomyModel& anatomy, const SceneRig& rig, StationWall& wall);

}  // namespace cathlab
