// A recorded run against the same run made again: the trace has every channel of every step, the hashes all of the
// state every 50 steps.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "record/run_reader.h"

namespace cathlab {

class RunVerifier {
public:
    /// run: outlives this.  Throws UserError where its trace cannot be read or has not the run's steps.
    explicit RunVerifier(const RunRecord& run);

    /// Before the step of this index (steps = steps done).  False if the state differs; then difference() says where.
    bool state(std::int64_t steps, World& world);
    /// After the step of this index.
    void channels(std::int64_t step, const Channels& now);

    bool channels_agree() const { return channel_step_ < 0; }
    /// Of a channel, where the state agrees.
    std::string channel_difference() const;
    /// The first difference of the state; "" = none.
    const std::string& difference() const { return difference_; }
    /// State hashes so far.
    std::size_t compared() const { return next_; }

private:
    const RunRecord& run_;
    std::vector<Channels> trace_;
    std::size_t next_ = 0;
    std::int64_t channel_step_ = -1;
    std::string channel_, difference_;
};

}  // namespace cathlab
