// Bends of a steerable catheter that bring its tip to a place and keep it in the middle of the vessel.
#pragma once

#include <vector>

#include "catheter/shape.h"
#include "task/way.h"

namespace cathlab {

struct Bends {
    std::vector<Vec2> wanted;  ///< one a segment: bend (cos direction, sin direction), rad
    double cost = 0.0;         ///< of the catheter so bent; means nothing but that less is better
};

struct SteeringGoal {
    Vec3 tip = Vec3::Zero();  ///< where the tip is wanted, mm
    double weight = 1.0;      ///< of its distance against that of the steerable part from the way
    double room_mm = 0.0;     ///< wanted between the catheter and the wall of the way; less of it costs
    Vec3 off = Vec3::Zero();  ///< where the vessels are believed to be, less where they are, mm
};

/// Looks from `start` by steps along each bend that shrink (pattern search [hooke1961]) for the bends at which
/// the catheter, inserted by insertion_mm on the rail, lies nearest to the way, keeps its room, and the tip comes
/// nearest to its goal.  The catheter is predicted by its frames of constant curvature, the wall by the radii along the
/// way.
Bends steer(const CatheterSpec& spec, const CatheterState& state, const Rail& rail, double insertion_mm, const Way& way,
            const SteeringGoal& goal, const Bends& start);

struct Approach {
    Bends bends;
    double advance_mm = 0.0;  ///< span, 0 or -span
};

/// Whether to go on, stay or draw back, and with which bends: steer() for the insertion as it is, and for span_mm more
/// and less of it.  Where they do not differ clearly, it stays.
Approach approach(const CatheterSpec& spec, const CatheterState& state, const Rail& rail, double span_mm,
                  const Way& way, const SteeringGoal& goal, const Bends& start);

/// The bends of a state.
Bends bends_of(const CatheterState& state);

}  // namespace cathlab
