#include "autopilot/autopilot.h"

#include <algorithm>
#include <cmath>

#include "autopilot/steering.h"
#include "beam/c_arm.h"
#include "beam/exposure.h"
#include "core/check.h"
#include "core/deterministic_math.h"
#include "core/random.h"
#include "core/units.h"
#include "scene/entry.h"
#include "step/parts.h"

namespace cathlab {

namespace {

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
constexpr double span_mm = 3.0;                      // by which a plan goes on or back
constexpr double clear_mm = 12.0;                    // drawn back from a wall that refuses the catheter
constexpr double less_room = 0.6;                    // share of the room that it still wants, where it cannot get near
constexpr double free_bar = 0.05;                    // the force bar of a catheter that touches nothing
constexpr double end_mm = 5.0;                       // of a way, that gives its direction at the goal
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
           goal_node(*anatomy_, task)),
      attention_(skill, seed) {}

double Autopilot::noisy(double value, std::uint64_t what) const {
    const auto tick = static_cast<std::uint64_t>(static_cast<double>(step_) * dt_ / tremor_s);
    return value * (1.0 + skill_.tremor * random_normal(seed_, RandomStream::operator_, tick, what));
}

/// By how much things are believed to be off, world.
Vec3 Autopilot::believed_off(const World& world) const {
    const BeamSpec& beam = *world.first<BeamSpec>();
    const BeamState& state = *world.first<BeamState>();
    const CArmPose view = c_arm_pose(beam.c_arm, beam.isocentre, state.primary_deg, state.secondary_deg);
    const Vec3& off = attention_.off_mm();
    return off.x() * view.right + off.y() * view.down + off.z() * view.forward;
}

Input Autopilot::act(const World& world, const Channels& last, Input base) {
    Input input = base;
    const Vec3 now = goal_.now(world);
    middle_ = step_ == 0 ? now : Vec3(middle_ + dt_ / beats_s * (now - middle_));
    seen_.push_back({last, middle_, now});
    const auto delay = static_cast<std::size_t>(std::lround(skill_.reaction_s / dt_));
    ++step_;
    if (step_ == 1 || seen_.size() <= delay) return input;  // nothing has been seen yet
    Seen seen = seen_.front();
    seen_.pop_front();
    if (seen.channels.time_s <= 0.0) return input;
    const bool wire = task_.device == "wire";
    const Channels& c = seen.channels;
    const Vec3 tip = wire ? Vec3(c.wire_tip_x_mm, c.wire_tip_y_mm, c.wire_tip_z_mm)
                          : Vec3(c.catheter_tip_x_mm, c.catheter_tip_y_mm, c.catheter_tip_z_mm);
    input.device = wire ? 0.0 : 1.0;
    attention_.step(dt_, !arrived_);
    // A wire lies in its vessel: of what is guessed only the part along the vessel can be believed.
    Vec3 off = believed_off(world);
    double beyond_end = 0.0;  // of the way, where it believes the goal to be
    if (wire) {
        const Vec3 along = (way_.at(way_.length_mm()) - way_.at(way_.length_mm() - end_mm)).normalized();
        beyond_end = off.dot(along);
        off = beyond_end * along;
    }
    seen.middle += off;
    seen.goal += off;
    if (wire)
        drive_wire(tip, seen, beyond_end, input);
    else
        drive_catheter(tip, seen, input);
    if (!wire) steer_catheter(world, seen.middle, off, input);
    // The hand may rest from moving; the eye needs the beam.
    input.fluoroscopy = input.advance != 0.0 || input.rotate != 0.0 || (attention_.looks() && !arrived_) ? 1.0 : 0.0;
    follow_with_table(world, tip, input);
    return in_range(input);  // the search for bends asks for more than there is, and a run keeps what was taken
}

/// Goes on with drawing back, and turns to come another way; false where there is nothing left of it.
bool Autopilot::draws_back(double arc_mm, Input& input) {
    if (back_mm_ <= 0.0) return false;
    input.advance = -noisy(skill_.speed_mm_s, 0);
    if (task_.device == "wire") input.rotate = noisy(turn_speed_deg_s, 1);
    back_mm_ += input.advance * dt_;
    stuck_s_ = 0.0;
    farthest_mm_ = arc_mm;
    return true;
}

bool Autopilot::stands(double to_goal, double now_to_goal) {
    arrived_ = to_goal < (arrived_ ? leave_share : hold_share) * near_enough_ * task_.radius_mm;
    stood_s_ = arrived_ ? stood_s_ + dt_ : 0.0;
    const bool swung_away = arrived_ && now_to_goal > task_.radius_mm;
    if (swung_away || stood_s_ > task_.hold_s + in_vain_s) {
        near_enough_ *= closer;
        stood_s_ = 0.0;
        attention_.guess_again();
    }
    return arrived_;
}

double Autopilot::push(double to_goal, double bar) const {
    const double calm = std::clamp(slower_ * to_goal / skill_.near_mm, slower_ * least_share, 1.0);
    return calm * std::clamp((skill_.caution - bar) / (skill_.caution - skill_.easy), 0.0, 1.0);
}

/// In a wrong branch: pushes on until it sees that, then draws back behind where it went in.
void Autopilot::go_astray(double share, Input& input) {
    input.advance = noisy(share * skill_.speed_mm_s, 0);
    astray_s_ += dt_;
    astray_mm_ += input.advance * dt_;
    if (astray_s_ < skill_.notice_s) return;
    back_mm_ = astray_mm_ + fork_mm * (1.0 + 0.5 * (attempts_++ % 4));
    astray_s_ = astray_mm_ = 0.0;
}

void Autopilot::drive_wire(const Vec3& tip, const Seen& seen, double beyond_end, Input& input) {
    if (attention_.looks()) return;
    const Way::Place place = way_.locate(tip);
    // It moves along with its vessel, so where the goal is now counts.
    const double to_goal = std::sqrt((seen.goal - tip).squaredNorm());
    const double ahead = way_.length_mm() + beyond_end - place.arc_mm;
    const bool beyond = ahead < hold_share * task_.radius_mm;
    const bool overshot = to_goal < overshot_mm && (beyond || place.astray);
    if (overshot && !overshot_) slower_ = std::max(slowest, slower_each * slower_);
    overshot_ = overshot;
    if (draws_back(place.arc_mm, input) || stands(to_goal, to_goal)) return;
    if (place.arc_mm > farthest_mm_ + progress_mm) {
        farthest_mm_ = place.arc_mm;
        stuck_s_ = 0.0;
    }
    const double share = push(to_goal, seen.channels.force_bar);
    if (place.astray) {
        go_astray(share, input);
        return;
    }
    astray_s_ = astray_mm_ = 0.0;
    if (beyond) {  // past the goal, or beside it at its height
        input.advance = -noisy(std::max(slower_ * least_share, share) * skill_.speed_mm_s, 0);
        return;
    }
    input.advance = noisy(share * skill_.speed_mm_s, 0);
    stuck_s_ += dt_;
    if (stuck_s_ > skill_.notice_s / std::max(slower_ * least_share, share)) {
        back_mm_ = draw_back_mm * (1.0 + attempts_++ % 3);
        stuck_s_ = 0.0;
    }
}

void Autopilot::drive_catheter(const Vec3& tip, const Seen& seen, Input& input) {
    if (attention_.looks()) return;
    const Way::Place place = way_.locate(tip);
    const double to_goal = std::sqrt((seen.middle - tip).squaredNorm());
    if (draws_back(place.arc_mm, input)) {
        refused_s_ = 0.0;
        nearest_mm_ = to_goal;
        return;
    }
    if (stands(to_goal, std::sqrt((seen.goal - tip).squaredNorm()))) return;
    // Pushed harder than it can hold, a catheter slips back on its own and drags over the wall: better to leave the
    // wall at once.
    refused_s_ = seen.channels.catheter_refused > 0.5 ? refused_s_ + dt_ : 0.0;
    if (near_ && refused_s_ > skill_.notice_s) {
        back_mm_ = clear_mm;
        return;
    }
    if (place.arc_mm > farthest_mm_ + progress_mm || to_goal < nearest_mm_ - progress_mm) {
        farthest_mm_ = std::max(farthest_mm_, place.arc_mm);
        nearest_mm_ = std::min(nearest_mm_, to_goal);
        stuck_s_ = 0.0;
    }
    const double share = push(to_goal, seen.channels.force_bar);
    if (place.astray) {
        go_astray(share, input);
        return;
    }
    astray_s_ = astray_mm_ = 0.0;
    const double wanted = near_ ? std::clamp(seeks_mm_, -1.0, 1.0) : 1.0;
    input.advance = noisy(wanted * share * skill_.speed_mm_s, 0);
    stuck_s_ += dt_;
    if (stuck_s_ > skill_.notice_s / std::max(least_share, share)) {
        if (near_) room_ *= less_room;
        const bool free = near_ && seen.channels.force_bar < free_bar;  // the room alone keeps it from the goal
        back_mm_ = free ? 0.0 : near_ ? clear_mm : draw_back_mm * (1.0 + attempts_++ % 3);
        stuck_s_ = 0.0;
    }
}

void Autopilot::steer_catheter(const World& world, const Vec3& goal, const Vec3& off, Input& input) {
    const auto every = std::max<std::uint64_t>(1, static_cast<std::uint64_t>(std::lround(look_every_s / dt_)));
    if (step_ % every == 0 && !arrived_ && !attention_.looks()) {
        const CatheterSpec& spec = *world.first<CatheterSpec>();
        const CatheterState& state = *world.first<CatheterState>();
        const CatheterRoute& route = *world.first<CatheterRoute>();
        const Way::Place tip = way_.locate(route.shape.tip.position);
        const bool was_near = near_;
        near_ = back_mm_ <= 0.0 && (near_ || way_.length_mm() - tip.arc_mm < reach_mm);
        SteeringGoal target{goal, aiming, room_ * skill_.room_mm, off};
        Bends bends;
        if (near_) {
            Approach plan = approach(spec, state, route.laid, span_mm, way_, target, bends_of(state));
            if (!was_near) nearest_mm_ = std::sqrt((goal - route.shape.tip.position).squaredNorm());
            seeks_mm_ = plan.advance_mm;
            bends = std::move(plan.bends);
        } else {
            const double soon = input.advance * look_every_s;
            target.tip = way_.at(tip.arc_mm + soon) + off;
            target.weight = travelling;
            bends =
                steer(spec, state, route.laid, std::max(0.0, state.insertion_mm + soon), way_, target, bends_of(state));
        }
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
