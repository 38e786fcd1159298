// What the benchmarks share: samples of a time, and clocks.
#pragma once

#include <time.h>

#include <algorithm>
#include <chrono>
#include <nlohmann/json.hpp>
#include <vector>

namespace cathlab {

/// Samples of one thing, ms.
class Samples {
public:
    void add(double ms) { ms_.push_back(ms); }
    double median() { return quantile(0.5); }
    double p99() { return quantile(0.99); }
    double sum() const {
        double all = 0.0;
        for (const double ms : ms_) all += ms;
        return all;
    }
    nlohmann::ordered_json json() { return {{"median_ms", median()}, {"p99_ms", p99()}, {"count", ms_.size()}}; }

private:
    double quantile(double share) {
        std::sort(ms_.begin(), ms_.end());
        const auto k = static_cast<std::size_t>(share * static_cast<double>(ms_.size()));
        return ms_.at(std::min(k, ms_.size() - 1));
    }
    std::vector<double> ms_;
};

/// By the clock on the wall.
template <class Work>
double ms_of(const Work& work) {
    using Clock = std::chrono::steady_clock;
    const auto begin = Clock::now();
    work();
    return std::chrono::duration<double, std::milli>(Clock::now() - begin).count();
}

/// Of this thread's processor time: what others do on the machine does not show, but for its caches.
template <class Work>
double processor_ms_of(const Work& work) {
    const auto now = [] {
        timespec t{};
        ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
        return 1e3 * static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_nsec);
    };
    const double begin = now();
    work();
    return now() - begin;
}

}  // namespace cathlab
