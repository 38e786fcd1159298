// A guidewire inside a catheter: rows that keep it within the catheter's lumen.
#pragma once

#include <span>
#include <vector>

#include "core/types.h"
#include "rod/chain_row.h"
#include "rod/rod.h"

namespace cathlab {

/// The centre-line of the catheter from the sheath's mouth to its tip.
struct CatheterBore {
    std::span<const Vec3> points;  ///< (n >= 2) mm, world, mouth first
    std::span<const double> arc;   ///< (n) mm from the mouth, rising
    double clearance_mm = 0.0;     ///< inner radius of the catheter less the wire's radius, >= 0
    double friction = 0.05;        ///< Coulomb coefficient between wire and bore
};

/// Which samples of the wire lie inside the bore: those whose arc length from the mouth, measured along the wire, is
/// less than the bore's.  arc_of_sample: (samples) mm.
bool inside_bore(const CatheterBore& bore, double arc_of_sample);

/// Appends one row a sample inside the bore: it lets the point move freely within the clearance and pushes it back from
/// the bore's wall.  The catheter is kinematic, so the partner gives way by `compliance` alone (mm/mN, small and > 0,
/// so that the chain's system stays well conditioned). The foot point is the nearest one of the bore within `window_mm`
/// of the sample's own arc length: a bore that curls back on itself cannot catch the wrong turn.
void add_bore_rows(const CatheterBore& bore, std::span<const RodSample> samples, std::span<const double> arc_of_sample,
                   double compliance, std::vector<ChainRow>& rows);

}  // namespace cathlab
