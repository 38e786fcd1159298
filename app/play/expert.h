// An expert's run of a session's scene, for comparison: found among the user's data, or flown there beside the window.
#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "context.h"
#include "play/simulation.h"
#include "scene/build_world.h"

namespace cathlab::play {

struct ExpertCourse {
    Metrics metrics;
    Course course;
    bool reached = false;
    double score = 0.0;
};

class Expert {
public:
    explicit Expert(const AppContext& context) : context_(context) {}
    /// Stops a flight; nothing of it stays.
    ~Expert();

    /// Gives the course where the same scene has been flown before, and otherwise nothing.  home: the folder of all
    /// experts' runs; the run of a task's own scene stands in home/TASK, as
    ///     cathlab run scenes/tasks/TASK.toml --operator autopilot --video none --out home/TASK
    /// makes it, that of a changed one in home/TASK-HASH.
    static std::optional<ExpertCourse> find(const SceneSpec& scene, const std::string& home);

    /// Begins to fly.  threaded = false: done when it returns.
    void fly(const SceneSpec& scene, std::shared_ptr<const SceneModels> models, const std::string& home, bool threaded);
    bool busy() const { return busy_; }
    /// Seconds of simulated time that it has flown.
    double flown_s() const { return flown_s_; }
    /// "" or why there is none.
    std::string fault() const;

private:
    const AppContext& context_;
    std::thread thread_;
    std::atomic<bool> busy_ = false, given_up_ = false;
    std::atomic<double> flown_s_ = 0.0;
    mutable std::mutex mutex_;
    std::string fault_;
};

}  // namespace cathlab::play
