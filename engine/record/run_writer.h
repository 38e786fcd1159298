// Writes a run folder while a run goes on.  It reads the world's hash and channels and never writes to the world.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/channels.h"
#include "core/event.h"
#include "core/input.h"
#include "record/manifest.h"
#include "record/run_files.h"
#include "world/world.h"

namespace cathlab {

class RunWriter {
public:
    /// The folder must stand (prepare_run_folder).  Writes manifest.json with complete = false.
    /// entities: their names in the order of World::state_hash().
    RunWriter(const std::string& folder, RunManifest manifest, const std::vector<std::string>& entities);

    /// The input that the step of this index (0 = the first) is about to get.  Only changes are written,
    /// as the step takes them (in_range).
    void input(std::int64_t step, const Input& wanted);
    /// After the step of this index: the channels, and what happened.  Flushed every 25 steps.
    void step(std::int64_t step, const Channels& channels, const std::vector<Event>& events);
    /// Hands over to the system what a crash of this process would lose.
    void flush();
    /// Whether step() flushes after the step of this index.
    static bool flushes(std::int64_t step);
    /// After `steps` steps; written if steps is a multiple of hash_interval or `last`.
    static bool wants_hash(std::int64_t steps) { return steps % hash_interval == 0; }
    void hash(std::int64_t steps, const World::StateHash& hash);
    /// Another whole file of the folder, such as metrics.json.
    void file(const std::string& name, const std::string& text) const;

    /// Closes the logs and writes the final manifest.  complete = false: the run was stopped.
    void finish(std::int64_t steps, bool complete, double wall_time_s, const std::string& video);

    const std::string& folder() const { return folder_; }

private:
    std::string folder_;
    RunManifest manifest_;
    LineFile inputs_, trace_, events_, hashes_;
    std::optional<Input> last_input_;
};

/// What events.jsonl says of an event.
std::string event_line(const Event& event);

/// The row of a table in which "nan" and "inf" may stand; numbers read back to the same bits.
std::string exact_number(double value);

}  // namespace cathlab
