// A contact row as the chain solve sees it: one point of one link, pushed along a normal, with a partner that gives
// way. The chain solve condenses the rows into its own linear system, so a row sees the effective compliance of the
// whole chain and not one link's mass; the multiplier that it returns is what the partner must receive, with opposite
// sign.
#pragma once

#include "core/types.h"

namespace cathlab {

struct ChainRow {
    Index link = 0;               ///< index of the link in the chain, 0 = nearest to the tip
    Vec3 arm = Vec3::Zero();      ///< from the link's centre to the point, world frame, mm
    Vec3 normal = Vec3::UnitZ();  ///< unit, world: direction in which a positive multiplier pushes the link
    double gap = 0.0;         ///< signed distance along normal between the surfaces NOW (partner's current place), mm
    double compliance = 0.0;  ///< the partner gives way by compliance * (change of multiplier), mm/mN; > 0
    double multiplier = 0.0;  ///< in/out: normal force on the link, mN; >= 0 unless bilateral
    bool bilateral = false;   ///< keep gap = 0 both ways

    double friction = 0.0;     ///< Coulomb coefficient; 0 = none
    Vec3 slip = Vec3::Zero();  ///< tangential motion of the point against the partner since the substep began, mm
    Vec3 tangent_force = Vec3::Zero();  ///< in/out: friction force on the link, mN, world; |.| <= friction * multiplier
    Vec3 held = Vec3::Zero();           ///< friction force when the substep began, mN: what sticks keeps it
};

}  // namespace cathlab
