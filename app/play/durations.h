// How long something took, many times: shares of all, in little memory.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

namespace cathlab::play {

class Durations {
public:
    void add(double seconds) {
        const double bin = std::clamp(seconds / bin_s, 0.0, static_cast<double>(bins_.size() - 1));
        ++bins_[static_cast<std::size_t>(bin)];
        ++count_;
    }
    std::uint64_t count() const { return count_; }
    /// The value that this share of them did not pass, s; to 0.2 ms, at most 2 s; 0 where there are none.
    double quantile(double share) const {
        std::uint64_t sum = 0;
        for (std::size_t i = 0; i < bins_.size() && count_ > 0; ++i) {
            sum += bins_[i];
            if (static_cast<double>(sum) >= share * static_cast<double>(count_))
                return static_cast<double>(i + 1) * bin_s;
        }
        return 0.0;
    }

private:
    static constexpr double bin_s = 2e-4;
    std::array<std::uint32_t, 10000> bins_{};
    std::uint64_t count_ = 0;
};

}  // namespace cathlab::play
