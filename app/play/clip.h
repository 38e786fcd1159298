// The last ten seconds of fluoroscopy, kept as they come and written as a film when asked for.
#pragma once

#include <cstdint>
#include <deque>
#include <future>
#include <string>
#include <vector>

#include "imaging/image.h"

namespace cathlab::play {

class ClipKeeper {
public:
    /// A picture of simulated time time_s.  One of another size, or of an earlier time, begins anew.
    void add(const Image8& picture, double time_s);
    void clear() { frames_.clear(); }
    /// Writes what there is beside the window's work: pictures at equal intervals of 1 / fps, each held until the next.
    /// False where there is nothing yet or one is still being written.
    bool save(const std::string& path, double fps);
    /// Once for each clip that is done: "" or the sentence about it.
    std::string report();
    std::size_t count() const { return frames_.size(); }

private:
    struct Frame {
        double time_s = 0.0;
        std::vector<std::uint8_t> grey;
    };
    std::deque<Frame> frames_;
    int side_ = 0;
    std::future<std::string> writing_;
};

}  // namespace cathlab::play
