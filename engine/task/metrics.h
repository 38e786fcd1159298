// What a run was like, in numbers, from its channels alone: the same recording gives the same numbers to the last bit.
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "core/channels.h"
#include "core/types.h"
#include "task/detours.h"

namespace cathlab {

struct Metrics {
#define CATHLAB_METRIC(name, unit, doc) double name = 0.0;
#include "task/metrics.inl"
#undef CATHLAB_METRIC
};

struct MetricInfo {
    std::string_view name;
    std::string_view unit;
    std::string_view doc;
    double Metrics::*value;
};

/// In the order of metrics.inl, which is the order of metrics.json.
std::span<const MetricInfo> metric_table();

/// nullptr where there is none of that name.
const MetricInfo* find_metric(std::string_view name);

/// Contact events of a force in N: a rise above `on` begins one, a fall under `off` ends it, and a new rise within
/// `refractory_s` goes on with the same.  The peak of an event counts when the event is over, or at the end.
class ContactEvents {
public:
    void add(double force_n, double dt);
    int count() const { return count_; }
    double peak_sum_n() const { return closed_peaks_ + peak_; }
    double impulse_ns() const { return impulse_; }

private:
    static constexpr double on = 0.02, off = 0.01, refractory_s = 0.2;
    int count_ = 0;
    bool touching_ = false;
    double since_ = refractory_s;  // time since the last contact ended
    double peak_ = 0.0, closed_peaks_ = 0.0, impulse_ = 0.0;
};

/// One device's share of the metrics.
class DeviceTrack {
public:
    /// advance_mm, rotation_deg: at the sheath; bends in deg.  Returns whether the operator's drives moved.
    bool add(const Vec3& tip, double advance_mm, double rotation_deg, double bend_1_deg, double bend_2_deg, double dt);
    double path_mm() const { return path_; }
    double rotation_deg() const { return rotation_total_; }
    int reversals() const { return reversals_; }
    /// Speed of the tip in mm/s, one value a step, 0 for the first.
    const std::vector<double>& speed() const { return speed_; }

private:
    bool first_ = true;
    Vec3 tip_ = Vec3::Zero();
    double advance_ = 0.0, rotation_ = 0.0, bend_1_ = 0.0, bend_2_ = 0.0;
    double path_ = 0.0, rotation_total_ = 0.0;
    double turning_point_ = 0.0;  // the farthest advance in the present direction
    int direction_ = 0, reversals_ = 0;
    std::vector<double> speed_;
};

class MetricsAccumulator {
public:
    /// What the run is about: whose tip ("wire" or "catheter") is to go to which landmark.  Before the first step.
    void set_task(std::shared_ptr<const AnatomyModel> anatomy, const std::string& device, const std::string& landmark);

    /// One step's channels; dt in s, above 0 and the same for all steps of a run (CATHLAB_CHECK).
    void add(const Channels& channels, double dt);
    Metrics result() const;
    bool empty() const { return force_n_.empty(); }

private:
    double dt_ = 0.0;
    double duration_ = 0.0, idle_ = 0.0, above_limit_ = 0.0, bar_max_ = 0.0, roadmap_ = 0.0;
    double first_motion_ = -1.0;
    std::size_t first_moving_step_ = 0, last_moving_step_ = 0;
    DeviceTrack wire_, catheter_;
    Detours detours_;
    bool about_wire_ = true;
    ContactEvents contacts_;
    std::vector<double> force_n_;
    Channels last_;
};

}  // namespace cathlab
