// The task that a scene sets, and where its goal is while the wall moves.
#pragma once

#include <optional>

#include "scene/scene_spec.h"
#include "softbody/wall_place.h"
#include "task/task.h"
#include "world/world.h"

namespace cathlab {

/// The scene's [task], checked; empty where it sets none.  Throws UserError: a metric that there is not, a number out
/// of range.
std::optional<TaskSpec> task_of(const SceneSpec& scene);

/// The middle of the goal region.  It goes along with the wall round it: the landmark at rest and the mean displacement
/// of the wall's particles that are nearest to it.
class GoalPoint {
public:
    /// Throws UserError where the world's anatomy has no such landmark.
    GoalPoint(const World& world, const TaskSpec& task);

    /// World, mm.
    Vec3 now(const World& world) const;

private:
    WallPlace place_;
};

}  // namespace cathlab
