#include "explain/beat_clock.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace cathlab {

double beat_phase(const std::vector<double>& beats, double time_s) {
    const auto next = std::upper_bound(beats.begin(), beats.end(), time_s);
    if (next == beats.begin() || next == beats.end()) return std::numeric_limits<double>::quiet_NaN();
    const double begin = *(next - 1);
    return (time_s - begin) / (*next - begin);
}

BeatClock::BeatClock(const Dataset& data) {
    const auto& all = data.heart.beat_times_s;
    recorded_ = !all.empty() && std::all_of(all.begin(), all.end(), [](const auto& b) { return b.size() >= 2; });
    if (!recorded_) return;
    std::vector<double> usual;
    for (const auto& beats : all) {
        std::vector<double> lengths;
        for (std::size_t k = 1; k < beats.size(); ++k) lengths.push_back(beats[k] - beats[k - 1]);
        const auto middle = lengths.begin() + static_cast<std::ptrdiff_t>(lengths.size() / 2);
        std::nth_element(lengths.begin(), middle, lengths.end());
        usual.push_back(*middle);
    }
    for (std::size_t i = 0; i < data.rows(); ++i) {
        const auto run = static_cast<std::size_t>(data.run[i]);
        const std::vector<double>& beats = all[run];
        const double t = data.time_s[i];
        BeatTime row;
        row.usual_s = usual[run];
        row.interval = 1.0;
        const auto next = std::upper_bound(beats.begin(), beats.end(), t);
        const auto begun = next - beats.begin();  // beats that have begun
        row.number = begun;
        row.phase = beat_phase(beats, t);
        if (std::isnan(row.phase)) {
            const bool before = begun == 0;
            const double length = before ? beats[1] - beats[0] : beats.back() - beats[beats.size() - 2];
            const double place = (t - (before ? beats.front() : beats.back())) / length;
            row.phase = place - std::floor(place);
            row.number += static_cast<std::int64_t>(std::floor(place));
        }
        const auto k = static_cast<std::size_t>(begun);
        if (begun >= 2) row.interval = (beats[k - 1] - beats[k - 2]) / row.usual_s;
        rows_.push_back(row);
    }
}

}  // namespace cathlab
