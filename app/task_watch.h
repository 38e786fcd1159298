// A run under a task: what it has come to, step by step, and what is written of it at the end.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/channels.h"
#include "task/force_map.h"
#include "task/metrics.h"
#include "task/scene_task.h"
#include "world/world.h"

namespace cathlab {

/// Who sat at the controls.
struct OperatorName {
    std::string kind = "script";  ///< "script", "autopilot", "person"
    std::string skill;            ///< of the autopilot
    std::string difficulty = {};  ///< of a person: how much help there was
    /// Of a person: views that were looked at, each with the simulated time for which it stood in the window, s.
    std::vector<std::pair<std::string, double>> aids_s = {};
};

class TaskWatch {
public:
    /// Without a task: metrics alone.
    TaskWatch(const World& world, std::optional<TaskSpec> task);

    void add(const World& world, const Channels& channels, double dt);
    /// Whether the task has come to its end; never without one.
    bool over() const;
    bool reached() const;
    /// Null without a task.
    const GoalTracker* tracker() const { return tracker_ ? &*tracker_ : nullptr; }
    /// Where the goal is now, world, mm; with a task alone.
    Vec3 goal(const World& world) const { return goal_->now(world); }
    const std::optional<TaskSpec>& task() const { return task_; }
    Metrics metrics() const { return metrics_.result(); }
    const ForceMap& forces() const { return forces_; }
    bool empty() const { return metrics_.empty(); }
    /// 0 where the goal was not reached.
    double score() const;
    /// result.json; "" without a task.
    std::string result_json(const OperatorName& who) const;

private:
    std::optional<TaskSpec> task_;
    std::optional<GoalPoint> goal_;
    std::optional<GoalTracker> tracker_;
    MetricsAccumulator metrics_;
    ForceMap forces_;
};

}  // namespace cathlab
