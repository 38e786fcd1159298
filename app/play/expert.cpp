#include "play/expert.h"

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "core/errors.h"
#include "core/hash.h"
#include "record/run_reader.h"
#include "trial_run.h"

namespace cathlab::play {
namespace fs = std::filesystem;
namespace {

constexpr const char* skill = "expert";

std::string changed_folder(const SceneSpec& scene, const std::string& home) {
    return home + "/" + scene.name + "-" + hash_text(scene.hash);
}

nlohmann::json json_of(const std::string& path) {
    std::ifstream in(path);
    auto out = nlohmann::json::parse(in, nullptr, false);
    if (!in || !out.is_object()) throw UserError(path + ": is missing or no JSON object");
    return out;
}

ExpertCourse read_course(const std::string& folder, const SceneSpec& scene) {
    const RunRecord run = read_run(folder);
    if (run.manifest.scene_hash != scene.hash || !run.manifest.complete)
        throw UserError(folder + ": is no whole run of this scene");
    ExpertCourse out;
    const auto metrics = json_of(folder + "/metrics.json"), result = json_of(folder + "/result.json");
    for (const MetricInfo& metric : metric_table())
        if (const auto it = metrics.find(std::string(metric.name)); it != metrics.end() && it->is_number())
            out.metrics.*metric.value = it->get<double>();
    out.reached = result.value("reached", false);
    out.score = result.value("score", 0.0);
    const bool wire = scene.task.device == "wire";
    for (const Channels& c : read_trace(folder, true)) out.course.add(c, wire);
    return out;
}

}  // namespace

Expert::~Expert() {
    given_up_ = true;
    if (thread_.joinable()) thread_.join();
}

std::optional<ExpertCourse> Expert::find(const SceneSpec& scene, const std::string& home) {
    for (const std::string& folder : {home + "/" + scene.name, changed_folder(scene, home)}) {
        std::error_code error;
        if (!fs::exists(folder + "/manifest.json", error)) continue;
        try {
            return read_course(folder, scene);
        } catch (const std::exception&) {
            // Of another scene or another version of the program: it is flown anew under its own name.
        }
    }
    return std::nullopt;
}

void Expert::fly(const SceneSpec& scene, std::shared_ptr<const SceneModels> models, const std::string& home,
                 bool threaded) {
    if (busy_) return;
    if (thread_.joinable()) thread_.join();
    busy_ = true;
    flown_s_ = 0.0;
    const auto work = [this, scene, models = std::move(models), home] {
        std::string fault;
        try {
            std::error_code error;
            const std::string own = home + "/" + scene.name, folder = changed_folder(scene, home);
            fs::remove_all(folder, error);  // it was not readable
            PilotedRun run{scene.overlays.empty() && !fs::exists(own, error) ? own : folder, skill, scene.seed};
            run.go_on = [this](double time_s) {
                flown_s_ = time_s;
                return !given_up_;
            };
            cathlab::fly(run, scene, *models, context_);
        } catch (const std::exception& error) {
            fault = error.what();
        }
        const std::lock_guard lock(mutex_);
        fault_ = fault;
        busy_ = false;
    };
    if (threaded)
        thread_ = std::thread(work);
    else
        work();
}

std::string Expert::fault() const {
    const std::lock_guard lock(mutex_);
    return fault_;
}

}  // namespace cathlab::play
