// What the trainee is to do, whether it is done, and what it was worth.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "anatomy/model.h"
#include "core/channels.h"
#include "task/metrics.h"

namespace cathlab {

/// One number of the score: the part falls in a straight line from 1 at `full` to 0 at `none`, and is weighed.
struct Criterion {
    std::string metric;  ///< a name of metric_table()
    double full = 0.0;   ///< in the metric's unit; above or below `none`
    double none = 1.0;
    double weight = 1.0;  ///< >= 0
};

/// Bring a device's tip to a landmark and hold it there.
struct TaskSpec {
    std::string name;
    std::string instructions;
    std::string device = "wire";  ///< "wire" or "catheter": whose tip counts
    std::string landmark;         ///< of the anatomy
    double radius_mm = 5.0;       ///< the goal region is a ball, > 0
    double hold_s = 2.0;          ///< >= 0, without a break
    double time_limit_s = 300.0;  ///< from the first step, > 0
    double pass_score = 60.0;     ///< 0 to 100
    bool inner_view = true;       ///< may be looked at
    std::vector<Criterion> criteria;
};

/// Throws UserError for a number out of range or an unknown device or metric (with the nearest known name).
void check_task(const TaskSpec& spec);

/// Where the landmark is at rest; throws UserError where the anatomy has none of that name.
Vec3 goal_position(const TaskSpec& spec, const AnatomyModel& anatomy);

/// 100 * sum of weight * part / sum of weights; 100 where there are no criteria.
double score(const Metrics& metrics, std::span<const Criterion> criteria);

class GoalTracker {
public:
    enum class Outcome { open, reached, out_of_time };

    explicit GoalTracker(TaskSpec spec);

    /// One step.  goal: where the region's centre is now (the wall moves), world, mm.
    void add(const Channels& channels, const Vec3& goal, double dt);

    Outcome outcome() const { return outcome_; }
    bool inside() const { return inside_; }
    double distance_mm() const { return distance_; }
    double held_s() const { return held_; }
    /// Time from the first step to the end of the hold.
    std::optional<double> completed_at_s() const { return completed_at_; }
    const TaskSpec& spec() const { return spec_; }

private:
    TaskSpec spec_;
    Outcome outcome_ = Outcome::open;
    bool inside_ = false;
    double distance_ = 0.0, held_ = 0.0, time_ = 0.0;
    std::optional<double> completed_at_;
};

}  // namespace cathlab
