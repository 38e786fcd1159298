// What a wall at rest hands on to what holds it.
#pragma once

#include "step/rig.h"

namespace cathlab {

/// Sum of the forces on held ends and foundation, mN: k (x - g), what the goals ask of a particle that does not move,
/// and the springs of the others.  Loads that lie on held particles themselves are not in it.
inline Vec3 force_on_supports(RigRun& run) {
    const SoftBodyModel& wall = *run.parts.wall;
    const SoftBodyState& state = *run.parts.wall_state;
    solve_goals(wall, *run.parts.wall_state, *run.parts.wall_scratch, run.world->workers());
    Vec3 carried = Vec3::Zero();
    for (std::size_t i = 0; i < wall.size(); ++i)
        if (wall.fixed[i])
            carried += wall.stiffness[i] * (run.parts.wall_scratch->goal[i] - state.x[i]);
        else
            carried += wall.support[i] * (state.x[i] - wall.rest[i]);
    return carried;
}

}  // namespace cathlab
