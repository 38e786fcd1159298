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

void Course::add(const Channels& c, bool wire) {
    force_bar.push_back(static_cast<float>(c.force_bar));
    const Vec3 now = wire ? Vec3(c.wire_tip_x_mm, c.wire_tip_y_mm, c.wire_tip_z_mm)
                          : Vec3(c.catheter_tip_x_mm, c.catheter_tip_y_mm, c.catheter_tip_z_mm);
    if (tip.empty() || (now - tip.back()).norm() > onward_mm) tip.push_back(now);
    constexpr std::size_t most = 8192;
    if (tip.size() < most) return;
    for (std::size_t i = 0; 2 * i < tip.size(); ++i) tip[i] = tip[2 * i];
    tip.resize(most / 2);
    onward_mm *= 2.0;
}

Simulation::Simulation(SimulationOptions options, std::shared_ptr<const SceneModels> models, const AppContext& context)
    : options_(std::move(options)),
      models_(std::move(models)),
      session_(options_.scene, *models_, options_.replay ? options_.replay->manifest.seed : options_.scene.seed,
               options_.threads),
      pilot_(options_.scene, isocentre_of(session_)),
      watch_(session_.world(), options_.task) {
    if (options_.replay && session_.anatomy_hash() != options_.replay->manifest.anatomy_hash)
        throw UserError(options_.replay->folder + ": the anatomy is built otherwise than when this run was recorded");
    if (options_.task) {
        goal_.present = true;
        goal_.radius_mm = options_.task->radius_mm;
        goal_.hold_s = options_.task->hold_s;
        goal_.position = watch_.goal(session_.world());
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
    session_.step(input_);
    if (recorder_) recorder_->after();
    for (const Event& event : session_.events()) messages_.add(event);
    const Channels& c = channels();
    if (!std::isfinite(c.wire_tip_x_mm + c.catheter_tip_x_mm + c.wall_displacement_max_mm))
        throw std::runtime_error("its numbers are no longer finite; begin again");
    pulses_ = static_cast<std::uint64_t>(c.exposures);
    watch_.add(session_.world(), c, session_.dt());
    course_.add(c, options_.task ? options_.task->device == "wire" : input_.device < 0.5);
    ++steps_;
    if (goal_.present) follow_goal();
}

void Simulation::follow_goal() {
    const GoalTracker& tracker = *watch_.tracker();
    goal_.position = watch_.goal(session_.world());
    goal_.inside = tracker.inside();
    goal_.distance_mm = tracker.distance_mm();
    goal_.held_s = tracker.held_s();
    goal_.outcome = tracker.outcome();
    goal_.left_s = tracker.spec().time_limit_s - static_cast<double>(steps_) * session_.dt();
}

bool Simulation::over() const {
    return options_.replay ? steps_ >= options_.replay->steps : watch_.over();
}

std::optional<double> Simulation::score() const {
    return goal_.present ? std::optional(watch_.score()) : std::nullopt;
}

std::vector<std::vector<Vec3>> Simulation::vessels() {
    const CentrelineGraph& graph = (*session_.world().first<Shared<AnatomyModel>>())->centreline;
    std::vector<std::vector<Vec3>> out;
    for (const auto& [a, b] : graph.edges)
        out.push_back(
            {graph.nodes[static_cast<std::size_t>(a)].position, graph.nodes[static_cast<std::size_t>(b)].position});
    return out;
}

void Simulation::describe(FrameDescription& frame) {
    frame.seed = options_.scene.seed;
    frame.frame_index = pulses_;
    frame.inner_camera = camera_;
    take_poses(session_.world(), poses_);
    describe_frame(stage_of(session_.world()), poses_, options_.scene, channels(), {}, memory_, frame);
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
    const Metrics metrics = watch_.metrics();
    const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - begin_;
    if (!watch_.empty()) {
        recorder_->file("regions.csv", watch_.forces().regions_csv());
        recorder_->file("force-map.csv", force_map_csv(watch_.forces().unrolled()));
    }
    recorder_->finish(complete, wall.count(), watch_.empty() ? nullptr : &metrics);
}

}  // namespace cathlab::play
