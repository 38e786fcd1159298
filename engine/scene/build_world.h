// A scene -> a world: models built or fetched, states at rest, one entity for each thing that the scene names.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "anatomy/model.h"
#include "beam/exposure.h"
#include "scene/scene_spec.h"
#include "world/world.h"

namespace cathlab {

struct BuildOptions {
    int threads = 1;
    std::string cache_folder;  ///< for built anatomies; "" = build anew
    std::function<void(double fraction, std::string_view what)> progress;
};

/// What worlds of one scene share: built once, then any number of worlds.
struct SceneModels;
std::shared_ptr<const SceneModels> build_models(const SceneSpec& spec, const BuildOptions& options);

/// A world at rest, with the scene's seed or another.  Throws UserError for what the files could not know: an entry
/// that the anatomy does not have, a device wider than the vessel at its entry, a heart where there is no annulus.
std::unique_ptr<World> build_world(const SceneSpec& spec, const SceneModels& models, std::uint64_t seed, int threads);

/// Both in one.
std::unique_ptr<World> build_world(const SceneSpec& spec, const BuildOptions& options);

/// The anatomy alone, without the wall that build_models() makes of it: for who draws and does not step.
std::shared_ptr<const AnatomyModel> build_anatomy(const SceneSpec& spec, const BuildOptions& options);
/// The beam of every world of the scene.  Throws UserError for a C-arm that cannot be.
BeamSpec beam_spec(const SceneSpec& spec, const AnatomyModel& anatomy);

/// The anatomy in the models; it lives as long as they do.
const AnatomyModel& anatomy_of(const SceneModels& models);

/// Its content hash.
std::uint64_t anatomy_hash(const SceneModels& models);

}  // namespace cathlab
