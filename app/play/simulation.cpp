#include "play/simulation.h"

#include <cmath>
#include <limits>
#include <stdexcept>

#include "beam/exposure.h"
#include "core/errors.h"
#include "core/units.h"
#include "hud_fill.h"
#include "step/parts.h"

namespace cathlab::play {
namespace {

Vec3 isocentre_of(Session& session) {
    const auto* beam = session.world().first<BeamSpec>();
    return beam != nullptr ? beam->isocentre : Vec3::Zero();
}

}  // namespace

Simulation::Simulation(SimulationOptions options, const SceneModels& models, const AppContext& context)
    : options_(std::move(options)),
      session_(options_.scene, models, options_.replay ? options_.replay->manifest.seed : options_.scene.seed,
               options_.threads),
      pilot_(options_.scene, isocentre_of(session_)) {
    if (options_.replay && session_.anatomy_hash() != options_.replay->manifest.anatomy_hash)
        throw UserError(options_.replay->folder + ": the anatomy is built otherwise than when this run was recorded");
    if (options_.task) {
        goal_point_.emplace(session_.world(), *options_.task);
        tracker_.emplace(*options_.task);
        metrics_.set_task(*session_.world().first<Shared<AnatomyModel>>(), options_.task->device,
                          options_.task->landmark);
        goal_.present = true;
        goal_.radius_mm = options_.task->radius_mm;
        goal_.hold_s = options_.task->hold_s;
        goal_.position = goal_point_->now(session_.world());
        goal_.left_s = options_.task->time_limit_s;
    }
    input_ = session_.base_input();
    if (!options_.recorder) return;
    try {
        recorder_.emplace(*options_.recorder, session_, context);
    } catch (const UserError& error) {
        fault_ = std::string("this run is not recorded: ") + error.what();
    }
}

Simulation::~Simulation() {
    finish(false);
}

void Simulation::step(const Controls& controls, const InputSettings& settings) {
    input_ = options_.replay ? options_.replay->input_at(steps_)
                             : pilot_.step(controls, settings, channels(), session_.dt());
    if (recorder_) recorder_->before(input_);
    const auto before = session_.world().step_index;
    session_.step(input_);
    if (recorder_) recorder_->after();
    for (const Event& event : session_.events()) messages_.add(event);
    const Channels& c = channels();
    if (!std::isfinite(c.wire_tip_x_mm + c.catheter_tip_x_mm + c.wall_displacement_max_mm))
        throw std::runtime_error("its numbers are no longer finite; begin again");
    if (c.beam_on > 0.5 && pulse_in_step(before, session_.dt(), options_.scene.c_arm.frame_rate)) ++pulses_;
    metrics_.add(c, session_.dt());
    course_.force_bar.push_back(static_cast<float>(c.force_bar));
    course_.force_n.push_back(static_cast<float>((c.wire_force_mn + c.catheter_force_mn) / units::newton));
    course_.tip.push_back(input_.device < 0.5 ? Vec3(c.wire_tip_x_mm, c.wire_tip_y_mm, c.wire_tip_z_mm)
                                              : Vec3(c.catheter_tip_x_mm, c.catheter_tip_y_mm, c.catheter_tip_z_mm));
    ++steps_;
    if (tracker_) follow_goal();
}

void Simulation::follow_goal() {
    goal_.position = goal_point_->now(session_.world());
    tracker_->add(channels(), goal_.position, session_.dt());
    goal_.inside = tracker_->inside();
    goal_.distance_mm = tracker_->distance_mm();
    goal_.held_s = tracker_->held_s();
    goal_.outcome = tracker_->outcome();
    goal_.left_s = tracker_->spec().time_limit_s - static_cast<double>(steps_) * session_.dt();
}

bool Simulation::over() const {
    if (options_.replay) return steps_ >= options_.replay->steps;
    return tracker_ && tracker_->outcome() != GoalTracker::Outcome::open;
}

std::optional<double> Simulation::score() const {
    if (!tracker_) return std::nullopt;
    if (tracker_->outcome() != GoalTracker::Outcome::reached) return 0.0;
    return cathlab::score(metrics_.result(), tracker_->spec().criteria);
}

void Simulation::describe(FrameDescription& frame) {
    frame.seed = options_.scene.seed;
    frame.frame_index = pulses_;
    frame.inner_camera = camera_;
    describe_frame(session_.world(), options_.scene, channels(), {}, memory_, frame);
    frame.outer_map = outer_map_;
    camera_ = frame.inner_camera;
}

void Simulation::fill_panels(HudData& out) {
    fill_hud(options_.scene, channels(), out);
    messages_.at(channels().time_s, out.messages);
}

void Simulation::flush() {
    if (recorder_) recorder_->flush();
}

void Simulation::finish(bool complete) {
    if (finished_ || !recorder_) return;
    finished_ = true;
    const Metrics metrics = metrics_.result();
    const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - begin_;
    recorder_->finish(complete, wall.count(), metrics_.empty() ? nullptr : &metrics);
}

}  // namespace cathlab::play
