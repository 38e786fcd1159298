#include "task_watch.h"

#include <nlohmann/json.hpp>

#include "anatomy/model.h"
#include "world/step_settings.h"

namespace cathlab {

TaskWatch::TaskWatch(const World& world, std::optional<TaskSpec> task) : task_(std::move(task)), forces_(world) {
    if (!task_) return;
    goal_.emplace(world, *task_);
    tracker_.emplace(*task_);
    metrics_.set_task(*world.first<Shared<AnatomyModel>>(), task_->device, task_->landmark);
}

void TaskWatch::add(const World& world, const Channels& channels, double dt) {
    metrics_.add(channels, dt);
    forces_.add(world, dt);
    if (tracker_) tracker_->add(channels, goal_->now(world), dt);
}

bool TaskWatch::over() const {
    return tracker_ && tracker_->outcome() != GoalTracker::Outcome::open;
}

bool TaskWatch::reached() const {
    return tracker_ && tracker_->outcome() == GoalTracker::Outcome::reached;
}

double TaskWatch::score() const {
    return reached() ? cathlab::score(metrics(), task_->criteria) : 0.0;
}

std::string TaskWatch::result_json(const OperatorName& who) const {
    if (!task_) return "";
    const Metrics m = metrics();
    const auto completed = tracker_->completed_at_s();
    nlohmann::ordered_json out{{"task", task_->name},
                               {"operator", who.kind},
                               {"skill", who.skill},
                               {"reached", reached()},
                               {"completed_at_s", completed ? nlohmann::json(*completed) : nlohmann::json()},
                               {"score", score()},
                               {"pass_score", task_->pass_score},
                               {"passed", reached() && score() >= task_->pass_score},
                               {"play_time_s", m.play_time_s},
                               {"force_bar_max", m.force_bar_max},
                               {"fluoroscopy_time_s", m.fluoroscopy_time_s}};
    if (!who.difficulty.empty()) out["difficulty"] = who.difficulty;
    for (const auto& [name, seconds] : who.aids_s) out["aids"][name] = seconds;
    return out.dump(2) + "\n";
}

}  // namespace cathlab
