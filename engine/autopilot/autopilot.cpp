#include "autopilot/autopilot.h"

#include <algorithm>
#include <cmath>

#include "autopilot/steering.h"
#include "beam/exposure.h"
#include "core/check.h"
#include "core/deterministic_math.h"
#include "core/random.h"
#include "core/units.h"
#include "scene/entry.h"
#include "step/parts.h"

namespace cathlab {

namespace {

constexpr double patience_s = 1.5;                   // of pushing without getting on
constexpr double progress_mm = 2.0;                  // less is not getting on
constexpr double draw_back_mm = 20.0;                // when stuck
constexpr double fork_mm = 25.0;                     // drawn back behind where it went astray
constexpr double turn_speed_deg_s = 90.0;            // while it draws back: no two attempts come from one side
constexpr double tremor_s = 0.1;                     // the hand's noise stays so long
constexpr double look_every_s = 0.1;                 // between two looks at the bends
constexpr double least_share = 0.15;                 // of the speed, beside the goal
constexpr double hold_share = 0.3;                   // of the goal's radius: nearer is good enough to stand still
constexpr double leave_share = 0.6;                  // having stood still, it moves again beyond this
constexpr double in_vain_s = 3.0;                    // standing longer than the hold takes: the goal swings away
constexpr double closer = 0.7;                       // then it has to be so much nearer
constexpr double overshot_mm = 30.0;                 // astray so near the goal, it came too fast
constexpr double slower_each = 0.75, slowest = 0.2;  // and comes so much slower the next time
constexpr double reach_mm = 25.0;                    // from here on the catheter aims at the goal itself
constexpr double travelling = 0.05, aiming = 20.0;   // weights of the tip's goal (steering.h)
constexpr double most_table_mm = 1000.0;
constexpr double beats_s = 1.0;  // the goal swings with the heart; the hand aims at its middle

double degrees(double rad) {
    return rad * 180.0 / units::pi;
}

Index goal_node(const AnatomyModel& anatomy, const TaskSpec& task) {
    for (const Landmark& landmark : anatomy.landmarks)
        if (landmark.name == task.landmark) return landmark.node;
    CATHLAB_CHECK(false, "a goal's landmark is looked up before");
    return 0;
}

}  // namespace

Autopilot::Autopilot(const World& world, const SceneSpec& scene, const TaskSpec& task, const Skill& skill,
                     std::uint64_t seed)
    : task_(task),
      skill_(skill),
      seed_(seed),
      dt_(scene.step.dt_s),
      goal_(world, task),
      anatomy_(*world.first<Shared<AnatomyModel>>()),
      way_(anatomy_->centreline,
           find_way_in(*anatomy_, task.device == "wire" ? scene.wire : scene.catheter, true).entry.node,
           goal_node(*anatomy_, task)) {}

double Autopilot::noisy(double value, std::uint64_t what) const {
    const auto tick = static_cast<std::uint64_t>(static_cast<double>(step_) * dt_ / tremor_s);
    return value * (1.0 + skill_.tremor * random_normal(seed_, RandomStream::operator_, tick, what));
}

Input Autopilot::act(const World& world, const Channels& last, Input base) {
    Input input = base;
    const Vec3 now = goal_.now(world);
    middle_ = step_ == 0 ? now : Vec3(middle_ + dt_ / beats_s * (now - middle_));
    seen_.push_back({last, middle_});
    const auto delay = static_cast<std::size_t>(std::lround(skill_.reaction_s / dt_));
    ++step_;
    if (step_ == 1 || seen_.size() <= delay) return input;  // nothing has been seen yet
    const Seen seen = seen_.front();
    seen_.pop_front();
    if (seen.channels.time_s <= 0.0) return input;
    const bool wire = task_.device == "wire";
    const Channels& c = seen.channels;
    const Vec3 tip = wire ? Vec3(c.wire_tip_x_mm, c.wire_tip_y_mm, c.wire_tip_z_mm)
                          : Vec3(c.catheter_tip_x_mm, c.catheter_tip_y_mm, c.catheter_tip_z_mm);
    input.device = wire ? 0.0 : 1.0;
    drive(tip, seen.goal, c.force_bar, input);
    if (!wire) steer_catheter(world, seen.goal, input);
    input.fluoroscopy = input.advance != 0.0 || input.rotate != 0.0 ? 1.0 : 0.0;
    follow_with_table(world, tip, input);
    return in_range(input);  // the search for bends asks for more than there is, and a run keeps what was taken
}

void Autopilot::drive(const Vec3& tip, const Vec3& goal, double bar, Input& input) {
    const Way::Place place = way_.locate(tip);
    const double to_goal = std::sqrt((goal - tip).squaredNorm());
    const double ahead = way_.length_mm() - place.arc_mm;
    const bool beyond = ahead < hold_share * task_.radius_mm && task_.device == "wire";
    const bool overshot = task_.device == "wire" && to_goal < overshot_mm && (beyond || place.astray);
    if (overshot && !overshot_) slower_ = std::max(slowest, slower_each * slower_);
    overshot_ = overshot;
    const double calm = std::clamp(slower_ * to_goal / skill_.near_mm, slower_ * least_share, 1.0);
    if (back_mm_ > 0.0) {  // drawing back, and turning to come another way
        input.advance = -noisy(skill_.speed_mm_s, 0);
        input.rotate = noisy(turn_speed_deg_s, 1);
        back_mm_ += input.advance * dt_;
        stuck_s_ = 0.0;
        farthest_mm_ = place.arc_mm;
        return;
    }
    arrived_ = to_goal < (arrived_ ? leave_share : hold_share) * near_enough_ * task_.radius_mm;
    stood_s_ = arrived_ ? stood_s_ + dt_ : 0.0;
    if (stood_s_ > task_.hold_s + in_vain_s) {
        near_enough_ *= closer;
        stood_s_ = 0.0;
    }
    if (arrived_) return;
    if (place.astray) {
        back_mm_ = fork_mm * (1.0 + 0.5 * (attempts_++ % 4));
        return;
    }
    if (place.arc_mm > farthest_mm_ + progress_mm) {
        farthest_mm_ = place.arc_mm;
        stuck_s_ = 0.0;
    }
    if (beyond) {  // past the goal, or beside it at its height
        input.advance = -noisy(calm * skill_.speed_mm_s, 0);
        return;
    }
    const double ease = std::clamp((skill_.caution - bar) / (skill_.caution - skill_.easy), 0.0, 1.0);
    input.advance = noisy(calm * ease * skill_.speed_mm_s, 0);
    stuck_s_ += dt_;
    if (stuck_s_ > patience_s / std::max(slower_ * least_share, calm * ease)) {
        back_mm_ = draw_back_mm * (1.0 + attempts_++ % 3);
        stuck_s_ = 0.0;
    }
}

void Autopilot::steer_catheter(const World& world, const Vec3& goal, Input& input) {
    const auto every = std::max<std::uint64_t>(1, static_cast<std::uint64_t>(std::lround(look_every_s / dt_)));
    if (step_ % every == 0 && !arrived_) {
        const CatheterSpec& spec = *world.first<CatheterSpec>();
        const CatheterState& state = *world.first<CatheterState>();
        const CatheterRoute& route = *world.first<CatheterRoute>();
        const double soon = state.insertion_mm + input.advance * look_every_s;
        const Way::Place tip = way_.locate(route.shape.tip.position);
        near_ = back_mm_ <= 0.0 && (near_ || way_.length_mm() - tip.arc_mm < reach_mm);
        const SteeringGoal target{near_ ? goal : way_.at(tip.arc_mm + input.advance * look_every_s),
                                  near_ ? aiming : travelling};
        const Bends bends = steer(spec, state, route.laid, std::max(0.0, soon), way_, target, bends_of(state));
        if (!bends.wanted.empty()) proximal_ = bends.wanted.front();
        if (bends.wanted.size() > 1) distal_ = bends.wanted.back();
    }
    const auto put = [](const Vec2& bend, double& amount, double& direction) {
        amount = degrees(std::sqrt(bend.squaredNorm()));
        direction = degrees(det::atan2(bend.y(), bend.x()));
    };
    put(proximal_, input.proximal_bend, input.proximal_direction);
    put(distal_, input.distal_bend, input.distal_direction);
}

void Autopilot::follow_with_table(const World& world, const Vec3& tip, Input& input) const {
    const BeamSpec& beam = *world.first<BeamSpec>();
    input.table_longitudinal = std::clamp(tip.z() - beam.isocentre.z(), -most_table_mm, most_table_mm);
}

}  // namespace cathlab
