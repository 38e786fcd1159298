#include "play/loader.h"

#include <chrono>
#include <ctime>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "core/errors.h"
#include "record/run_files.h"
#include "recorded_scene.h"
#include "scene/load_scene.h"
#include "session.h"
#include "task/scene_task.h"

namespace cathlab::play {
namespace fs = std::filesystem;

std::string new_run_folder(const RunSettings& settings, const std::string& name) {
    std::string base = settings.folder;
    if (base.empty()) {
        const std::string data = data_home();
        if (data.empty()) throw UserError("neither XDG_DATA_HOME nor HOME is set, so there is no place for recordings");
        base = data + "/runs";
    }
    const std::time_t now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
    std::tm parts{};
    ::localtime_r(&now, &parts);
    char time[32];
    std::strftime(time, sizeof time, "%Y-%m-%d-%H%M%S-", &parts);
    const std::string wanted = base + "/" + time + name;
    std::string folder = wanted;
    std::error_code error;
    for (int i = 2; fs::exists(folder, error); ++i) folder = wanted + "-" + std::to_string(i);
    return folder;
}

Loader::~Loader() {
    given_up_ = true;
    if (thread_.joinable()) thread_.join();
}

void Loader::start(const LoadRequest& request, bool threaded) {
    if (thread_.joinable()) thread_.join();
    simulation_.reset();
    error_.clear();
    fraction_ = 0.0;
    busy_ = true;
    const auto work = [this, request] {
        try {
            load(request);
        } catch (const std::exception& error) {
            // No folder of a session that never began.
            std::error_code ignored;
            if (!folder_.empty() && !fs::exists(folder_ + "/manifest.json", ignored)) fs::remove_all(folder_, ignored);
            const std::lock_guard lock(mutex_);
            error_ = error.what();
        }
        busy_ = false;
    };
    if (threaded)
        thread_ = std::thread(work);
    else
        work();
}

std::string Loader::what() const {
    const std::lock_guard lock(mutex_);
    return what_;
}

std::string Loader::error() const {
    const std::lock_guard lock(mutex_);
    return error_;
}

std::unique_ptr<Simulation> Loader::take() {
    if (thread_.joinable()) thread_.join();
    return std::move(simulation_);
}

void Loader::load_replay(const LoadRequest& request, SimulationOptions& options) {
    options.replay = read_run(request.replay);
    options.scene = recorded_scene(*options.replay, context_);
}

void Loader::load_setup(const LoadRequest& request, SimulationOptions& options) {
    const Setup& setup = request.setup;
    const SceneSpec plain = load_scene(setup.scene, setup.overlays, context_.data_root);
    const std::string overlay = setup_toml(setup, plain);
    std::vector<std::string> overlays = setup.overlays;
    std::string folder;
    if (request.run.record) {
        try {
            folder = request.folder.empty() ? new_run_folder(request.run, setup.task.empty() ? plain.name : setup.task)
                                            : request.folder;
            prepare_run_folder(folder, false);
            folder_ = folder;
        } catch (const UserError& error) {
            if (!request.folder.empty()) throw;  // the user named it
            const std::lock_guard lock(mutex_);
            error_ = std::string("this run is not recorded: ") + error.what();
            folder.clear();
        }
    }
    if (!overlay.empty()) {
        const std::string where = folder.empty() ? fs::temp_directory_path().string() : folder;
        overlays.push_back(where + "/setup.toml");
        write_whole_file(overlays.back(), overlay);
    }
    options.scene = overlay.empty() ? plain : load_scene(setup.scene, overlays, context_.data_root);
    if (request.seed) options.scene.seed = *request.seed;
    if (!setup.task.empty()) options.task = task_of(options.scene);
    if (folder.empty()) return;
    RecorderOptions recorder;
    recorder.folder = folder;
    recorder.overlays = overlays;
    recorder.threads = options.threads;
    recorder.trial = request.trial;
    if (request.trial.empty() && !request.run.participant.empty())
        recorder.trial =
            nlohmann::ordered_json{
                {"participant", request.run.participant}, {"group", ""}, {"task", setup.task}, {"trial", 0}}
                .dump(2) +
            "\n";
    options.recorder = recorder;
}

void Loader::load(const LoadRequest& request) {
    SimulationOptions options;
    options.threads = static_cast<int>(request.run.threads);
    folder_.clear();
    if (request.replay.empty())
        load_setup(request, options);
    else
        load_replay(request, options);
    if (!models_ || models_of_ != options.scene.hash) {
        BuildOptions build;
        build.threads = default_threads();
        build.cache_folder = context_.cache_folder;
        build.progress = [this](double fraction, std::string_view what) {
            if (given_up_) throw UserError("given up");
            fraction_ = fraction;
            const std::lock_guard lock(mutex_);
            what_ = what;
        };
        models_ = build_models(options.scene, build);
        models_of_ = options.scene.hash;
    }
    simulation_ = std::make_unique<Simulation>(std::move(options), models_, context_);
}

}  // namespace cathlab::play
