// The tube of a contact bench as the tests have it: held by its ends, so that a ball may be pushed into its wall.
#pragma once

#include "softbody/push_rig.h"

namespace cathlab {

/// Radius 12 mm about z from 0, 1.5 mm thick, 1.2 MPa; particles 3 mm apart.
inline PushRig held_tube(double length_mm) {
    PushRig rig;
    rig.particle_spacing_mm = 3.0;
    rig.lumen = straight_lumen(12.0, length_mm, rig.particle_spacing_mm);
    rig.thickness_mm = 1.5;
    rig.young_kpa = 1200.0;
    for (const double z : {0.0, length_mm}) rig.held.push_back({Vec3(0, 0, z), Vec3::UnitZ(), 15.0, 0.1});
    return rig;
}

}  // namespace cathlab
