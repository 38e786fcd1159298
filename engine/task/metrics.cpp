#include "task/metrics.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "core/check.h"
#include "core/units.h"
#include "task/smoothness.h"

namespace cathlab {

std::span<const MetricInfo> metric_table() {
    static constexpr std::array table{
#define CATHLAB_METRIC(name, unit, doc) MetricInfo{#name, unit, doc, &Metrics::name},
#include "task/metrics.inl"
#undef CATHLAB_METRIC
    };
    return table;
}

const MetricInfo* find_metric(std::string_view name) {
    for (const MetricInfo& m : metric_table())
        if (m.name == name) return &m;
    return nullptr;
}

void ContactEvents::add(double force_n, double dt) {
    if (touching_ ? force_n < off : force_n <= on) {
        if (touching_) since_ = 0.0;
        touching_ = false;
        since_ += dt;
        return;
    }
    if (!touching_ && since_ >= refractory_s) {
        ++count_;
        closed_peaks_ += peak_;
        peak_ = 0.0;
    }
    touching_ = true;
    peak_ = std::max(peak_, force_n);
    impulse_ += force_n * dt;
}

bool DeviceTrack::add(const Vec3& tip, double advance_mm, double rotation_deg, double bend_1_deg, double bend_2_deg,
                      double dt) {
    constexpr double still_mm_s = 0.5, still_deg_s = 1.0, least_travel_mm = 1.0;
    bool moved = false;
    if (first_) {
        speed_.push_back(0.0);
        turning_point_ = advance_mm;
    } else {
        const double travelled = std::sqrt((tip - tip_).squaredNorm());
        path_ += travelled;
        speed_.push_back(travelled / dt);
        const double turned = std::fabs(rotation_deg - rotation_);
        rotation_total_ += turned;
        const double bent = std::max(std::fabs(bend_1_deg - bend_1_), std::fabs(bend_2_deg - bend_2_));
        // The comparison allows for the last bits of a difference of two positions.
        moved = std::fabs(advance_mm - advance_) > still_mm_s * dt * (1.0 + 1e-9) ||
                std::max(turned, bent) > still_deg_s * dt * (1.0 + 1e-9);
        const double from_turn = advance_mm - turning_point_;
        if (direction_ == 0 || from_turn * direction_ < 0.0) {
            if (std::fabs(from_turn) >= least_travel_mm) {
                reversals_ += direction_ == 0 ? 0 : 1;
                direction_ = from_turn > 0.0 ? 1 : -1;
                turning_point_ = advance_mm;
            }
        } else {
            turning_point_ = advance_mm;
        }
    }
    first_ = false;
    tip_ = tip;
    advance_ = advance_mm;
    rotation_ = rotation_deg;
    bend_1_ = bend_1_deg;
    bend_2_ = bend_2_deg;
    return moved;
}

void MetricsAccumulator::set_task(std::shared_ptr<const AnatomyModel> anatomy, const std::string& device,
                                  const std::string& landmark) {
    detours_ = Detours(std::move(anatomy), landmark);
    about_wire_ = device == "wire";
}

void MetricsAccumulator::add(const Channels& c, double dt) {
    CATHLAB_CHECK(dt > 0.0, "a step must take time");
    CATHLAB_CHECK(dt_ == 0.0 || dt == dt_, "all steps of a run must be of one length");
    dt_ = dt;
    const bool wire_moved = wire_.add({c.wire_tip_x_mm, c.wire_tip_y_mm, c.wire_tip_z_mm}, c.wire_insertion_mm,
                                      c.wire_rotation_deg, 0.0, 0.0, dt);
    const bool catheter_moved =
        catheter_.add({c.catheter_tip_x_mm, c.catheter_tip_y_mm, c.catheter_tip_z_mm}, c.catheter_insertion_mm,
                      c.catheter_rotation_deg, c.catheter_proximal_bend_deg, c.catheter_distal_bend_deg, dt);
    if (wire_moved || catheter_moved) {
        if (first_motion_ < 0.0) {
            first_motion_ = duration_;
            first_moving_step_ = force_n_.size();
        }
        last_moving_step_ = force_n_.size();
    } else if (first_motion_ >= 0.0) {
        idle_ += dt;
    }
    detours_.add(about_wire_ ? Vec3(c.wire_tip_x_mm, c.wire_tip_y_mm, c.wire_tip_z_mm)
                             : Vec3(c.catheter_tip_x_mm, c.catheter_tip_y_mm, c.catheter_tip_z_mm),
                 dt);
    force_n_.push_back((c.wire_force_mn + c.catheter_force_mn) / units::newton);
    contacts_.add(c.force_bar_n, dt);
    bar_max_ = std::max(bar_max_, c.force_bar);
    if (c.force_bar > 1.0) above_limit_ += dt;
    if (c.beam_on > 0.5 && c.roadmap > 0.5) roadmap_ += dt;
    duration_ += dt;
    last_ = c;
}

namespace {

/// Linear between order statistics; `values` need not be sorted and must not be empty.
double percentile(std::vector<double> values, double part) {
    std::sort(values.begin(), values.end());
    const double place = part * static_cast<double>(values.size() - 1);
    const auto low = static_cast<std::size_t>(place);
    const std::size_t high = std::min(low + 1, values.size() - 1);
    return values[low] + (place - static_cast<double>(low)) * (values[high] - values[low]);
}

}  // namespace

Metrics MetricsAccumulator::result() const {
    Metrics m;
    if (empty()) return m;
    m.duration_s = duration_;
    m.wire_path_mm = wire_.path_mm();
    m.catheter_path_mm = catheter_.path_mm();
    const double way = detours_.way_mm();
    m.path_ratio = way > 0.0 ? (about_wire_ ? m.wire_path_mm : m.catheter_path_mm) / way : 0.0;
    m.wrong_branches = detours_.wrong_branches();
    m.wire_rotation_total_deg = wire_.rotation_deg();
    m.catheter_rotation_total_deg = catheter_.rotation_deg();
    m.wire_reversals = wire_.reversals();
    m.catheter_reversals = catheter_.reversals();

    std::vector<double> touching;
    std::copy_if(force_n_.begin(), force_n_.end(), std::back_inserter(touching), [](double f) { return f > 0.0; });
    const double sum = std::accumulate(force_n_.begin(), force_n_.end(), 0.0);
    m.force_mean_n = sum / static_cast<double>(force_n_.size());
    m.force_impulse_ns = sum * dt_;
    if (!touching.empty()) {
        m.force_mean_in_contact_n = sum / static_cast<double>(touching.size());
        m.force_max_n = *std::max_element(touching.begin(), touching.end());
        m.force_p95_n = percentile(touching, 0.95);
    }
    m.force_bar_max = bar_max_;
    m.time_above_limit_s = above_limit_;
    m.contacts = contacts_.count();
    m.accumulated_collision_n = contacts_.peak_sum_n();
    m.collision_impulse_ns = contacts_.impulse_ns();
    m.fluoroscopy_time_s = last_.beam_time_s;
    m.roadmap_time_s = roadmap_;
    m.air_kerma_mgy = last_.air_kerma_mgy;
    m.dose_area_product_gycm2 = last_.dose_area_product_gycm2;
    m.contrast_ml = last_.contrast_injected_ml;

    if (first_motion_ < 0.0) return m;
    m.play_time_s = duration_ - first_motion_;
    m.idle_time_s = idle_;
    // One step more at either end, so that the profile begins and ends at rest.
    const std::size_t begin = first_moving_step_ > 0 ? first_moving_step_ - 1 : 0;
    const std::size_t end = std::min(last_moving_step_ + 2, force_n_.size());
    const auto played = [&](const DeviceTrack& track) {
        return std::span<const double>(track.speed()).subspan(begin, end - begin);
    };
    m.wire_sparc = spectral_arc_length(played(wire_), dt_);
    m.catheter_sparc = spectral_arc_length(played(catheter_), dt_);
    m.wire_ldlj = log_dimensionless_jerk(played(wire_), dt_);
    m.catheter_ldlj = log_dimensionless_jerk(played(catheter_), dt_);
    return m;
}

}  // namespace cathlab
