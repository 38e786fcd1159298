// Reads a run folder back, strictly: what was truncated or edited is named with file and line.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "core/channels.h"
#include "core/event.h"
#include "core/input.h"
#include "record/manifest.h"
#include "world/world.h"

namespace cathlab {

struct RecordedHash {
    std::int64_t steps = 0;  ///< done when it was taken
    World::StateHash hash;
};

/// manifest.json, inputs.jsonl and hashes.csv of one run.
struct RunRecord {
    std::string folder;
    RunManifest manifest;
    std::vector<std::pair<std::int64_t, Input>>
        inputs;                        ///< first step, from which on it holds; ascending, the first is 0
    std::vector<RecordedHash> hashes;  ///< ascending
    std::int64_t steps =
        0;  ///< that can be replayed: all of a finished run, up to the last input, row or hash of a broken one

    const Input& input_at(std::int64_t step) const;
};

/// Throws UserError: no run folder, a file missing, lines truncated (in a run that was finished), edited, out of order.
RunRecord read_run(const std::string& folder);

/// One row of trace.csv a step.  Throws UserError with file:line; columns must be those of this program's channels.
std::vector<Channels> read_trace(const std::string& folder, bool complete);

/// The lines of events.jsonl.  Throws UserError with file:line.
std::vector<Event> read_events(const std::string& folder, bool complete);

/// What differs first: "" when the two agree; otherwise the name of the first entity whose hash differs, or a sentence
/// when the entities themselves differ.
std::string first_difference(const World::StateHash& recorded, const World::StateHash& now);

/// The name of the first channel whose bits differ, or nullptr.
const ChannelInfo* first_difference(const Channels& recorded, const Channels& now);

}  // namespace cathlab
