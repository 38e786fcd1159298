// manifest.json: what a run was made with.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace cathlab {

struct RunManifest {
    int schema = 1;
    std::string version;                ///< of the program
    std::string scene;                  ///< path as it was given, relative to the data root where it lies there
    std::vector<std::string> overlays;  ///< in the order in which they were laid
    std::string scene_name;
    std::uint64_t scene_hash = 0;
    std::uint64_t anatomy_hash = 0;
    std::string script;  ///< path, or ""
    std::uint64_t seed = 0;
    double dt_s = 0.0;
    int threads = 1;
    std::string host;
    std::string started_utc;   ///< ISO 8601; "" in a run without a clock
    double wall_time_s = 0.0;  ///< from the first step to the last
    std::int64_t steps = 0;    ///< done
    std::string video;         ///< file name inside the folder, or ""
    bool complete = false;     ///< false until the run ended by itself: also after a crash or Ctrl-C
};

std::string manifest_json(const RunManifest& manifest);

/// Throws UserError with the file: not JSON, a key missing, of the wrong type or unknown, a newer schema.
RunManifest parse_manifest(const std::string& text, const std::string& file);

}  // namespace cathlab
