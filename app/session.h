// A scene's world and what comes out of it, step by step: the part that `run`, `replay` and `bench` share.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "context.h"
#include "core/channels.h"
#include "core/event.h"
#include "core/input.h"
#include "scene/build_world.h"
#include "scene/scene_spec.h"
#include "world/world.h"

namespace cathlab {

/// What worlds of a scene share, with progress on stderr.  From here on Ctrl-C sets a flag (context.h); where it comes
/// while the models are built, throws UserError, as for whatever the scene's files get wrong.
std::shared_ptr<const SceneModels> session_models(const SceneSpec& scene, int threads, const AppContext& context);

class Session {
public:
    /// Builds the world (with progress on stderr).  Throws UserError.
    Session(const SceneSpec& scene, std::uint64_t seed, int threads, const AppContext& context);
    /// The same from models that stand already: quick.
    Session(const SceneSpec& scene, const SceneModels& models, std::uint64_t seed, int threads);

    void step(const Input& input);

    const SceneSpec& scene() const { return scene_; }
    World& world() { return *world_; }
    const Channels& channels() const { return channels_; }
    /// What happened in the last step.
    const std::vector<Event>& events() const { return events_; }
    std::uint64_t anatomy_hash() const { return anatomy_hash_; }
    double dt() const { return scene_.step.dt_s; }
    /// Where a script is silent: the scene's C-arm angles, and nothing is done.
    Input base_input() const;
    std::vector<std::string> entity_names();

private:
    SceneSpec scene_;
    std::unique_ptr<World> world_;
    Channels channels_;
    std::vector<Event> events_;
    std::uint64_t anatomy_hash_ = 0;
};

/// The number of threads when nobody says: as many as the machine has less one, at least 1 and at most 4.
int default_threads();

}  // namespace cathlab
