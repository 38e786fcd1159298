#include "task/scene_task.h"

#include "core/errors.h"
#include "softbody/solver.h"
#include "world/step_settings.h"

namespace cathlab {

std::optional<TaskSpec> task_of(const SceneSpec& scene) {
    const SceneTask& task = scene.task;
    if (task.landmark.empty()) return std::nullopt;
    TaskSpec out;
    out.name = scene.name;
    out.instructions = task.instructions;
    out.device = task.device;
    out.landmark = task.landmark;
    out.radius_mm = task.radius_mm;
    out.hold_s = task.hold_s;
    out.time_limit_s = task.time_limit_s;
    out.pass_score = task.pass_score;
    out.inner_view = task.inner_view;
    for (const SceneCriterion& c : task.criteria) out.criteria.push_back({c.metric, c.full, c.none, c.weight});
    try {
        check_task(out);
    } catch (const UserError& error) {
        throw UserError(task.where, error.what());
    }
    const bool there = task.device == "wire" ? scene.wire.enabled : scene.catheter.enabled;
    if (!there) throw UserError(task.where, "the task wants the " + task.device + "'s tip, and this scene has none");
    return out;
}

GoalPoint::GoalPoint(const World& world, const TaskSpec& task)
    : place_(wall_place(**world.first<Shared<SoftBodyModel>>(),
                        {goal_position(task, **world.first<Shared<AnatomyModel>>()), Quat::Identity()})) {}

Vec3 GoalPoint::now(const World& world) const {
    return place_now(place_, **world.first<Shared<SoftBodyModel>>(), world.first<SoftBodyState>()->x).position;
}

}  // namespace cathlab
