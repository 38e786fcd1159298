// A setup -> a session that is ready to begin, beside the window.
#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "context.h"
#include "play/settings.h"
#include "play/setup.h"
#include "play/simulation.h"
#include "scene/build_world.h"

namespace cathlab::play {

struct LoadRequest {
    Setup setup;
    RunSettings run;
    std::string folder;                 ///< of the recording; "" = a new one under the settings' folder
    std::string trial;                  ///< text of trial.json; "" = by run.participant
    std::optional<std::uint64_t> seed;  ///< instead of the scene's
    std::string replay;                 ///< a run folder: it is replayed instead, and not recorded
};

class Loader {
public:
    explicit Loader(const AppContext& context) : context_(context) {}
    ~Loader();

    /// threaded = false: done when it returns.
    void start(const LoadRequest& request, bool threaded);
    bool busy() const { return busy_; }
    double fraction() const { return fraction_; }
    std::string what() const;

    /// After it is no longer busy: the simulation, or null; then error() says why.
    std::unique_ptr<Simulation> take();
    std::string error() const;
    std::string folder() const { return folder_; }

private:
    void load(const LoadRequest& request);
    void load_replay(const LoadRequest& request, SimulationOptions& options);
    void load_setup(const LoadRequest& request, SimulationOptions& options);

    const AppContext& context_;
    std::thread thread_;
    std::atomic<bool> busy_ = false, given_up_ = false;
    std::atomic<double> fraction_ = 0.0;
    mutable std::mutex mutex_;
    std::string what_, error_, folder_;
    std::unique_ptr<Simulation> simulation_;
    std::shared_ptr<const SceneModels> models_;  // of the last scene, for another go at it
    std::uint64_t models_of_ = 0;
};

/// FOLDER/2026-01-31-120000-name, with a number behind it where there is one already.
std::string new_run_folder(const RunSettings& settings, const std::string& name);

}  // namespace cathlab::play
