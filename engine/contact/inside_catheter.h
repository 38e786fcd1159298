// A guidewire in a catheter, or beside it: rows that keep it on the catheter's centre-line, or outside its wall.
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
};

/// Which samples of the wire lie inside the bore: those whose arc length from the mouth, measured along the wire, is
/// less than the bore's.
bool inside_bore(const CatheterBore& bore, double arc_from_mouth);

/// Appends two bilateral rows across the bore for samples inside it that stand at least `spacing_mm` apart.  The
/// catheter is kinematic, so the partner gives way by `compliance` alone (mm/mN, > 0); this spring stands for the
/// clearance between wire and bore (a few tenths of a millimetre under a newton), which a one-sided row would make
/// chatter. The foot point is the nearest one of the bore within 10 mm of the sample's own arc length: a bore that
/// curls back on itself cannot catch the wrong turn.
void add_bore_rows(const CatheterBore& bore, std::span<const RodSample> samples, std::span<const double> arc_from_mouth,
                   double spacing_mm, double compliance, std::vector<ChainRow>& rows);

/// The catheter's outer wall, for a wire beside it.
struct CatheterOutside {
    CatheterBore line;           ///< its centre-line
    double radius_mm = 0.0;      ///< of the catheter, > 0
    double compliance = 0.0;     ///< of its wall, mm/mN, > 0
    double margin_mm = 0.0;      ///< rows are made up to this distance between the surfaces
    double deepest_mm = 0.0;     ///< a wire that is deeper in is pushed out as if it were so deep: it is not shot out
    double near_mouth_mm = 0.0;  ///< so far from the catheter's sheath both come out of it, and nothing touches
    double friction = 0.0;       ///< Coulomb coefficient against a wire, >= 0
    std::span<const Vec3> line_before = {};  ///< the line's points when the substep began (the same material), mm;
                                             ///< empty = the catheter stands still
};

/// What a sample of the wire has done since the substep began: the wire's side of friction.
struct SampleMotion {
    Vec3 way = Vec3::Zero();       ///< of its centre, mm
    Vec3 rotation = Vec3::Zero();  ///< rotation vector of its link, rad
};

/// Appends one row for each sample (its place in `samples` named by `beside`) that is near the catheter's side: along
/// the way from the nearest point of the centre-line; the tip is round.  The wire that comes out of the tip is the
/// caller's to leave out.  motion: one a sample.  Friction begins anew in every substep: what slides is held back by
/// the coefficient times the load, what sticks creeps (chain_rows.cpp, creep_mm_s); the catheter's turn about its own
/// axis does not rub.
void add_outside_rows(const CatheterOutside& catheter, std::span<const RodSample> samples,
                      std::span<const SampleMotion> motion, std::span<const std::size_t> beside,
                      std::vector<ChainRow>& rows);

}  // namespace cathlab
