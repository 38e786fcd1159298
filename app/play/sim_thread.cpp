#include "play/sim_thread.h"

#include <algorithm>
#include <cmath>

namespace cathlab::play {
namespace {

constexpr double most_debt_s = 0.1;  // further behind than this, time is lost instead of made up for
constexpr double flush_s = 0.4;      // a crash may take less than a second
constexpr double keeps_pace = 0.95;  // of the pace that is asked for
constexpr auto idle = std::chrono::milliseconds(10);

double seconds(Clock::duration d) {
    return std::chrono::duration<double>(d).count();
}

Clock::duration of_seconds(double s) {
    return std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(s));
}

}  // namespace

SimThread::SimThread(std::unique_ptr<Simulation> simulation, bool threaded) : simulation_(std::move(simulation)) {
    due_ = measured_since_ = Clock::now();
    publish();
    if (threaded) thread_ = std::thread([this] { loop(); });
}

SimThread::~SimThread() {
    stop();
}

Simulation& SimThread::stop() {
    stopping_ = true;
    if (thread_.joinable()) thread_.join();
    return *simulation_;
}

void SimThread::post(const Controls& controls, const InputSettings& settings, std::uint64_t stamp) {
    const std::lock_guard lock(mutex_);
    controls_ = controls;
    // What was held for less than a step must not be lost: it counts for the next one.
    for (std::size_t i = 0; i < control_count; ++i)
        if (std::fabs(controls.value[i]) > std::fabs(pulse_.value[i])) pulse_.value[i] = controls.value[i];
    settings_ = settings;
    if (stamp_ == stamp) return;
    stamp_ = stamp;
    moved_.notify_one();
}

void SimThread::set_paused(bool paused) {
    paused_ = paused;
}

void SimThread::run_for(double seconds) {
    const double dt = simulation_->dt();
    if (!paused_) owed_s_ += seconds * time_scale_;
    while (run_to_ >= 0 && tick()) {
    }
    for (; owed_s_ >= dt - 1e-9; owed_s_ -= dt) tick();
    while (paused_ && steps_wanted_ > 0 && tick()) {
    }
    publish();
}

bool SimThread::tick() {
    const bool seeking = run_to_ >= 0;
    if (seeking && (simulation_->steps() >= run_to_ || simulation_->over())) {
        run_to_ = -1;
        paused_ = true;
        publish();
        return false;
    }
    if (!fault_.empty() || simulation_->over()) return false;
    if (paused_ && !seeking) {
        if (steps_wanted_ <= 0) return false;
        --steps_wanted_;
    }
    Controls controls;
    InputSettings settings;
    {
        const std::lock_guard lock(mutex_);
        controls = controls_;
        for (std::size_t i = 0; i < control_count; ++i) {
            if (std::fabs(pulse_.value[i]) > std::fabs(controls.value[i])) controls.value[i] = pulse_.value[i];
            pulse_.value[i] = 0.0;
        }
        settings = settings_;
        in_step_ = stamp_;
    }
    const std::lock_guard lock(world_);
    try {
        simulation_->step(controls, settings);
    } catch (const std::exception& error) {
        fault_ = error.what();
    }
    return true;
}

void SimThread::publish() {
    const std::lock_guard world(world_);
    Shot& shot = shots_.newest.back();
    simulation_->describe(shot.picture);
    const bool exposed = simulation_->pulses() != exposed_ && shot.picture.beam_on;
    if (exposed) {
        exposed_ = simulation_->pulses();
        simulation_->describe(shots_.exposures.back().picture);
    }
    const std::lock_guard lock(mutex_);
    shot.stamp = in_step_;
    if (exposed) {
        shots_.exposures.back().stamp = in_step_;
        shots_.exposures.publish();
    }
    status_.channels = simulation_->channels();
    status_.input = simulation_->input();
    simulation_->fill_panels(status_.panels);
    status_.goal = simulation_->goal();
    status_.view = shot.picture.view;
    const Pilot& pilot = simulation_->pilot();
    status_.has_wire = pilot.has_wire();
    status_.has_catheter = pilot.has_catheter();
    status_.catheter = pilot.catheter();
    status_.segment = pilot.segment();
    status_.jog = pilot.jog();
    status_.moves_table = pilot.moves_table();
    status_.follows = pilot.follows();
    status_.paused = paused_;
    status_.over = simulation_->over() || !fault_.empty();
    status_.steps = simulation_->steps();
    status_.replay_steps = simulation_->replay_steps();
    status_.time_scale = time_scale_;
    status_.real_time_factor = factor_;
    status_.behind = slow_seconds_ >= 2;
    status_.recording_fault = simulation_->recording_fault();
    status_.fault = fault_;
    shots_.newest.publish();
}

void SimThread::measure(double simulated_s) {
    measured_s_ += simulated_s;
    const double passed = seconds(Clock::now() - measured_since_);
    if (passed < 1.0) return;
    factor_ = measured_s_ / passed;
    slow_seconds_ = factor_ < keeps_pace * time_scale_ ? slow_seconds_ + 1 : 0;
    measured_since_ = Clock::now();
    measured_s_ = 0.0;
}

void SimThread::loop() {
    while (!stopping_) {
        if (seconds(Clock::now() - flushed_) > flush_s) {
            const std::lock_guard lock(world_);
            simulation_->flush();
            flushed_ = Clock::now();
        }
        const bool running = !paused_ && fault_.empty() && !simulation_->over();
        const bool seeking = run_to_ >= 0;
        if (!running && !seeking) {
            const bool stepped = tick();
            // A changed setting or a message must be seen while time stands still, too.
            publish();
            if (!stepped) std::this_thread::sleep_for(idle);
            due_ = measured_since_ = Clock::now();
            measured_s_ = 0.0;
            continue;
        }
        if (seeking) {
            for (int i = 0; i < 25 && tick(); ++i) {
            }
            publish();
            due_ = Clock::now();
            continue;
        }
        const auto now = Clock::now();
        const auto interval = of_seconds(simulation_->dt() / time_scale_);
        {
            // A hand that moves gets its step at once, at most one step ahead of time; the pace stays what it is.
            std::unique_lock lock(mutex_);
            const bool moved = stamp_ != in_step_;
            const auto begins = moved ? due_ - interval : due_;
            if (now < begins) {
                moved_.wait_until(lock, std::min(begins, now + of_seconds(0.05)),
                                  [&] { return !moved && stamp_ != in_step_; });
                continue;
            }
            pace_.late.add(std::max(0.0, seconds(now - due_)));
        }
        due_ += interval;
        if (now - due_ > of_seconds(most_debt_s)) due_ = now;
        if (tick()) measure(simulation_->dt());
        publish();
        const std::lock_guard lock(mutex_);
        pace_.cost.add(seconds(Clock::now() - now));
    }
    simulation_->flush();
}

Status SimThread::status() const {
    const std::lock_guard lock(mutex_);
    return status_;
}

SimThread::Pace SimThread::pace() const {
    const std::lock_guard lock(mutex_);
    return pace_;
}

void SimThread::between_steps(const std::function<void(Simulation&)>& work) {
    const std::lock_guard lock(world_);
    work(*simulation_);
}

}  // namespace cathlab::play
