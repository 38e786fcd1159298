// The simulation at its own pace: a thread of its own, or driven step by step by whoever holds it (tests).
#pragma once

#include <array>
#include <atomic>
#include <chrono>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "play/simulation.h"
#include "play/triple_buffer.h"

namespace cathlab::play {

using Clock = std::chrono::steady_clock;

/// What the painter gets: the newest state as a description, and how many X-ray pulses there have been.
struct Shot {
    FrameDescription picture;
    std::uint64_t pulses = 0;
    std::uint64_t stamp = 0;  ///< of the newest hands' command that is in it
};

/// What the screens show, copied whole.
struct Status {
    Channels channels;
    HudData panels;
    GoalView goal;
    CArmView view;
    bool catheter = false, jog = false, moves_table = false, follows = false, paused = false, over = false;
    int segment = 1;
    std::int64_t steps = 0, replay_steps = 0;
    double time_scale = 1.0;
    double real_time_factor = 0.0;  ///< simulated over passed time, of about the last second; 0 = not known
    bool behind = false;            ///< the machine cannot keep the pace that is asked for
    std::string recording_fault, fault;
};

/// How late steps began, against their due time, while time ran.
class Lateness {
public:
    void add(double late_s);
    std::uint64_t count() const { return count_; }
    /// The value that this share of the steps did not pass, s; to 0.1 ms.
    double quantile(double share) const;

private:
    static constexpr double bin_s = 1e-4;
    std::array<std::uint64_t, 5000> bins_{};
    std::uint64_t count_ = 0;
};

class SimThread {
public:
    SimThread(std::unique_ptr<Simulation> simulation, bool threaded);
    /// Stops the thread and closes the recording as incomplete where finish() was not called.
    ~SimThread();
    SimThread(const SimThread&) = delete;
    SimThread& operator=(const SimThread&) = delete;

    /// The hands' command from now on.  stamp rises with each change that is to be timed.
    void post(const Controls& controls, const InputSettings& settings, std::uint64_t stamp);
    void set_paused(bool paused);
    bool paused() const { return paused_; }
    /// While paused: that many steps.
    void single_steps(int count) { steps_wanted_ += count; }
    /// 0.1 to 4.
    void set_time_scale(double scale) { time_scale_ = scale; }
    double time_scale() const { return time_scale_; }
    /// Steps as fast as they come until this one, then paused (for the time line of a replay).
    void run_to(std::int64_t step) { run_to_ = step; }

    /// Without a thread: the steps that so much time holds at the time scale.
    void run_for(double seconds);

    Status status() const;
    TripleBuffer<Shot>& shots() { return shots_; }
    Lateness lateness() const;

    /// Stops time for good; then the simulation may be read.
    Simulation& stop();
    /// Calls `work` between two steps.
    void between_steps(const std::function<void(Simulation&)>& work);

private:
    void loop();
    bool tick();  // one step, if one is wanted; false = nothing to do now
    void publish();
    void measure(double simulated_s);

    std::unique_ptr<Simulation> simulation_;
    TripleBuffer<Shot> shots_;

    mutable std::mutex mutex_;  // of what follows
    Controls controls_, pulse_;
    InputSettings settings_;
    std::uint64_t stamp_ = 0;
    Status status_;
    Lateness lateness_;

    std::mutex world_;  // held during a step
    std::atomic<bool> paused_ = false, stopping_ = false;
    std::atomic<int> steps_wanted_ = 0;
    std::atomic<double> time_scale_ = 1.0;
    std::atomic<std::int64_t> run_to_ = -1;
    double owed_s_ = 0.0;  // of run_for
    std::string fault_;
    Clock::time_point due_, measured_since_;
    double measured_s_ = 0.0, factor_ = 0.0;
    int slow_seconds_ = 0;
    Clock::time_point flushed_ = Clock::now();
    std::thread thread_;
};

}  // namespace cathlab::play
