#include "task/scene_task.h"

#include <algorithm>
#include <numeric>

#include "core/errors.h"
#include "softbody/solver.h"
#include "world/step_settings.h"

namespace cathlab {

namespace {

constexpr std::size_t particles_of_goal = 12;

}  // namespace

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
    : rest_(goal_position(task, **world.first<Shared<AnatomyModel>>())) {
    const std::vector<Vec3>& wall = (*world.first<Shared<SoftBodyModel>>())->rest;
    std::vector<Index> order(wall.size());
    std::iota(order.begin(), order.end(), Index{0});
    const auto count = static_cast<std::ptrdiff_t>(std::min(particles_of_goal, order.size()));
    const auto away = [&](Index i) { return (wall[static_cast<std::size_t>(i)] - rest_).squaredNorm(); };
    std::partial_sort(order.begin(), order.begin() + count, order.end(),
                      [&](Index a, Index b) { return away(a) != away(b) ? away(a) < away(b) : a < b; });
    particles_.assign(order.begin(), order.begin() + count);
}

Vec3 GoalPoint::now(const World& world) const {
    const std::vector<Vec3>& rest = (*world.first<Shared<SoftBodyModel>>())->rest;
    const std::vector<Vec3>& x = world.first<SoftBodyState>()->x;
    Vec3 moved = Vec3::Zero();
    for (const Index i : particles_) moved += x[static_cast<std::size_t>(i)] - rest[static_cast<std::size_t>(i)];
    return particles_.empty() ? rest_ : Vec3(rest_ + moved / static_cast<double>(particles_.size()));
}

}  // namespace cathlab
