#include "task/task.h"

#include <algorithm>
#include <cmath>

#include "core/check.h"
#include "core/errors.h"

namespace cathlab {

void check_task(const TaskSpec& spec) {
    const std::string where = "task '" + spec.name + "': ";
    const std::vector<std::string> devices{"wire", "catheter"};
    if (std::find(devices.begin(), devices.end(), spec.device) == devices.end())
        throw UserError(where + "device '" + spec.device + "' is not one of " + comma_list(devices) +
                        did_you_mean(spec.device, devices));
    const auto need = [&](bool fine, const char* key, double found, const char* allowed) {
        if (!fine) throw UserError(where + key + " = " + std::to_string(found) + "; allowed: " + allowed);
    };
    need(std::isfinite(spec.radius_mm) && spec.radius_mm > 0.0, "radius_mm", spec.radius_mm, "above 0");
    need(std::isfinite(spec.hold_s) && spec.hold_s >= 0.0, "hold_s", spec.hold_s, "0 or more");
    need(std::isfinite(spec.time_limit_s) && spec.time_limit_s > 0.0, "time_limit_s", spec.time_limit_s, "above 0");
    for (const Criterion& c : spec.criteria) {
        if (find_metric(c.metric) == nullptr) {
            std::vector<std::string> known;
            for (const MetricInfo& m : metric_table()) known.emplace_back(m.name);
            throw UserError(where + "there is no metric '" + c.metric + "'" + did_you_mean(c.metric, known));
        }
        need(std::isfinite(c.weight) && c.weight >= 0.0, "weight", c.weight, "0 or more");
        need(std::isfinite(c.full) && std::isfinite(c.none) && c.full != c.none, "full", c.full,
             "a number that differs from 'none'");
    }
}

Vec3 goal_position(const TaskSpec& spec, const AnatomyModel& anatomy) {
    std::vector<std::string> known;
    for (const Landmark& landmark : anatomy.landmarks) {
        if (landmark.name == spec.landmark) return landmark.pose.position;
        known.push_back(landmark.name);
    }
    throw UserError("task '" + spec.name + "': anatomy '" + anatomy.name + "' has no landmark '" + spec.landmark + "'" +
                    did_you_mean(spec.landmark, known));
}

double score(const Metrics& metrics, std::span<const Criterion> criteria) {
    double sum = 0.0;
    double weights = 0.0;
    for (const Criterion& c : criteria) {
        const MetricInfo* info = find_metric(c.metric);
        if (info == nullptr) throw UserError("there is no metric '" + c.metric + "'");
        const double part = (metrics.*(info->value) - c.none) / (c.full - c.none);
        sum += c.weight * std::clamp(part, 0.0, 1.0);
        weights += c.weight;
    }
    return weights > 0.0 ? 100.0 * sum / weights : 100.0;
}

GoalTracker::GoalTracker(TaskSpec spec) : spec_(std::move(spec)) {
    check_task(spec_);
}

void GoalTracker::add(const Channels& c, const Vec3& goal, double dt) {
    CATHLAB_CHECK(dt > 0.0, "a step must take time");
    if (outcome_ != Outcome::open) return;
    const Vec3 tip = spec_.device == "wire" ? Vec3(c.wire_tip_x_mm, c.wire_tip_y_mm, c.wire_tip_z_mm)
                                            : Vec3(c.catheter_tip_x_mm, c.catheter_tip_y_mm, c.catheter_tip_z_mm);
    distance_ = std::sqrt((tip - goal).squaredNorm());
    const bool was_inside = inside_;
    inside_ = distance_ <= spec_.radius_mm;
    time_ += dt;
    held_ = inside_ && was_inside ? held_ + dt : 0.0;
    constexpr double rounding = 1e-9;  // a hold of 2 s is 100 steps of 0.02 s, whose sum is not 2
    if (inside_ && held_ >= spec_.hold_s - rounding) {
        outcome_ = Outcome::reached;
        completed_at_ = time_;
    } else if (time_ >= spec_.time_limit_s - rounding) {
        outcome_ = Outcome::out_of_time;
    }
}

}  // namespace cathlab
