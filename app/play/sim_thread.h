// The simulation at its own pace: a thread of its own, or driven step by step by whoever holds it (tests).
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "play/durations.h"
#include "play/simulation.h"
#include "play/triple_buffer.h"

namespace cathlab::play {

using Clock = std::chrono::steady_clock;

/// What the painter gets: a state as a description.
struct Shot {
    FrameDescription picture;
    std::uint64_t stamp = 0;  ///< of the newest hands' command that is in it
};
/// For two readers, so that a slow one keeps nothing from the other: every state, and those that an X-ray pulse
/// exposed.
struct Shots {
    TripleBuffer<Shot> newest, exposures;
};

/// What the screens show, copied whole.
struct Status {
    Channels channels;
    Input input;  ///< of the last step: the hand's, or the replay's
    HudData panels;
    GoalView goal;
    CArmView view;
    bool has_wire = false, has_catheter = false;
    bool catheter = false, jog = false, moves_table = false, follows = false, paused = false, over = false;
    int segment = 1;
    std::int64_t steps = 0, replay_steps = 0;
    double time_scale = 1.0;
    double real_time_factor = 0.0;  ///< simulated over passed time, of about the last second; 0 = not known
    bool behind = false;            ///< the machine cannot keep the pace that is asked for
    std::string recording_fault, fault;
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
    Shots& shots() { return shots_; }
    /// While time ran: how late steps began, against their due time, and what a step took with its description.
    struct Pace {
        Durations late, cost;
    };
    Pace pace() const;

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
    Shots shots_;
    std::uint64_t exposed_ = 0;  // the last pulse that was handed over

    mutable std::mutex mutex_;  // of what follows
    std::condition_variable moved_;
    Controls controls_, pulse_;
    InputSettings settings_;
    std::uint64_t stamp_ = 0, in_step_ = 0;  // the newest command, and that of the last step
    Status status_;
    Pace pace_;

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
