#include "run_verifier.h"

#include "core/errors.h"

namespace cathlab {

RunVerifier::RunVerifier(const RunRecord& run) : run_(run), trace_(read_trace(run.folder, run.manifest.complete)) {
    if (run.manifest.complete && static_cast<std::int64_t>(trace_.size()) != run.steps)
        throw UserError(run.folder + "/trace.csv: has " + std::to_string(trace_.size()) + " steps, the run " +
                        std::to_string(run.steps) + " (truncated or edited?)");
}

bool RunVerifier::state(std::int64_t steps, World& world) {
    if (next_ >= run_.hashes.size() || run_.hashes[next_].steps != steps) return true;
    const std::string entity = first_difference(run_.hashes[next_].hash, world.state_hash());
    ++next_;
    if (entity.empty()) return true;
    if (!difference_.empty()) return false;
    difference_ = "the state differs after step " + std::to_string(steps) + ", first in the entity '" + entity + "'";
    if (channel_step_ >= 0)
        difference_ += "; the first channel that differs is " + channel_ + " in step " + std::to_string(channel_step_);
    return false;
}

void RunVerifier::channels(std::int64_t step, const Channels& now) {
    if (channel_step_ >= 0 || step >= static_cast<std::int64_t>(trace_.size())) return;
    if (const ChannelInfo* channel = first_difference(trace_[static_cast<std::size_t>(step)], now)) {
        channel_ = std::string(channel->name);
        channel_step_ = step;
    }
}

std::string RunVerifier::channel_difference() const {
    return "the state agrees but the channel " + channel_ + " differs in step " + std::to_string(channel_step_) +
           " (trace.csv edited?)";
}

}  // namespace cathlab
