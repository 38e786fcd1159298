// What every recording says of itself, whoever made it.
#pragma once

#include <string>
#include <vector>

#include "context.h"
#include "record/manifest.h"
#include "scene/scene_spec.h"
#include "task/metrics.h"

namespace cathlab {

/// Everything of the manifest but script, seed, threads and what is known at the end.
RunManifest manifest_of(const SceneSpec& scene, const std::vector<std::string>& overlays, std::uint64_t anatomy_hash,
                        const AppContext& context);

/// "2026-01-31T12:00:00Z"
std::string utc_now();

/// metrics.json
std::string metrics_json(const Metrics& metrics);

}  // namespace cathlab
