// Bends of a steerable catheter that bring its tip to a place and keep it in the middle of the vessel.
#pragma once

#include <vector>

#include "catheter/shape.h"
#include "task/way.h"

namespace cathlab {

struct Bends {
    std::vector<Vec2> wanted;  ///< one a segment: bend (cos direction, sin direction), rad
};

struct SteeringGoal {
    Vec3 tip = Vec3::Zero();  ///< where the tip is wanted, mm
    double weight = 1.0;      ///< of its distance against that of the steerable part from the way
};

/// Looks from `start` by steps along each bend that shrink (pattern search [hooke1961]) for the bends at which
/// the catheter, inserted by insertion_mm on the rail, lies nearest to the way and the tip to its goal.
Bends steer(const CatheterSpec& spec, const CatheterState& state, const Rail& rail, double insertion_mm, const Way& way,
            const SteeringGoal& goal, Bends start);

/// The bends of a state.
Bends bends_of(const CatheterState& state);

}  // namespace cathlab
