#include "session.h"

#include <algorithm>
#include <thread>

#include "core/errors.h"
#include "progress.h"
#include "scene/script.h"
#include "step/step.h"
#include "world/step_settings.h"

namespace cathlab {
namespace {

void end_if_wanted() {
    if (stop_wanted()) throw UserError("stopped while the scene was being built; nothing was written");
}

}  // namespace

std::shared_ptr<const SceneModels> session_models(const SceneSpec& scene, int threads, const AppContext& context) {
    catch_stop_signals();  // here begins what takes long
    Progress progress("building");
    BuildOptions options;
    options.threads = threads;
    options.cache_folder = context.cache_folder;
    options.progress = [&](double fraction, std::string_view what) {
        end_if_wanted();
        progress.update(fraction, what);
    };
    auto models = build_models(scene, options);
    end_if_wanted();
    return models;
}

Session::Session(const SceneSpec& scene, std::uint64_t seed, int threads, const AppContext& context)
    : Session(scene, *session_models(scene, threads, context), seed, threads) {
    end_if_wanted();
}

Session::Session(const SceneSpec& scene, const SceneModels& models, std::uint64_t seed, int threads)
    : scene_(scene), world_(build_world(scene_, models, seed, threads)), anatomy_hash_(cathlab::anatomy_hash(models)) {
    prepare(*world_);
}

void Session::step(const Input& input) {
    cathlab::step(*world_, input, channels_);
    EventLog& log = *world_->first<EventLog>();
    events_ = std::move(log.pending);
    log.pending.clear();
}

Input Session::base_input() const {
    return cathlab::base_input(scene_);
}

std::vector<std::string> Session::entity_names() {
    std::vector<std::string> names;
    for (std::size_t i = 0; i < world_->entity_count(); ++i) names.push_back(world_->name(static_cast<Entity>(i)));
    return names;
}

int default_threads() {
    return std::clamp(static_cast<int>(std::thread::hardware_concurrency()) - 1, 1, 4);
}

}  // namespace cathlab
