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

namespace {

/// The shortest distance that nearly as many pairs of triggers have as any other.
double rhythm_of(const std::vector<double>& triggers) {
    constexpr double shortest = 0.25, longest = 2.5, width = 0.06, nearly = 0.85;
    std::vector<std::pair<double, double>> score;  // distance, how many pairs have it
    double most = 0.0;
    for (std::size_t i = 0; i < triggers.size(); ++i)
        for (std::size_t j = i + 1; j < triggers.size() && triggers[j] - triggers[i] <= longest; ++j) {
            const double d = triggers[j] - triggers[i];
            if (d < shortest) continue;
            double sum = 0.0;
            for (std::size_t a = 0; a < triggers.size(); ++a)
                for (std::size_t b = a + 1; b < triggers.size() && triggers[b] - triggers[a] <= longest; ++b) {
                    const double off = (triggers[b] - triggers[a] - d) / (width * d);
                    sum += std::exp(-off * off);
                }
            score.emplace_back(d, sum);
            most = std::max(most, sum);
        }
    std::sort(score.begin(), score.end());
    for (const auto& [d, sum] : score)
        if (sum >= nearly * most) return d;
    return 0.0;
}

}  // namespace

std::vector<double> beats_among(const std::vector<double>& triggers) {
    // Costs, in squares of a tenth of the rhythm: a trigger left out; an interval without any rhythm; a beat that none
    // was recorded of, which is dearer than two intervals without rhythm.
    constexpr double left_out = 3.0, no_rhythm = 25.0, missed = 60.0, part = 0.1;
    constexpr std::size_t farthest = 6;
    const double rhythm = rhythm_of(triggers);
    if (!(rhythm > 0.0)) return triggers;
    const std::size_t n = triggers.size();
    std::vector<double> cost(n, 0.0);
    std::vector<std::size_t> from(n, n);
    // Beats are missed before the first that is kept and after the last, too: a pause is no reason to begin after it.
    const auto beyond = [&](std::size_t a, std::size_t b) {
        return left_out * static_cast<double>(b - a) + missed * std::floor((triggers[b] - triggers[a]) / rhythm);
    };
    for (std::size_t j = 0; j < n; ++j) {
        cost[j] = beyond(0, j);
        for (std::size_t i = j > farthest ? j - farthest : 0; i < j; ++i) {
            const double d = (triggers[j] - triggers[i]) / rhythm, beats = std::max(1.0, std::round(d));
            const double off = (d - beats) / part;
            const double here = cost[i] + left_out * static_cast<double>(j - i - 1) + missed * (beats - 1.0) +
                                std::min(off * off, no_rhythm);
            if (here < cost[j]) {
                cost[j] = here;
                from[j] = i;
            }
        }
    }
    std::size_t last = n - 1;
    for (std::size_t j = 0; j < n; ++j)
        if (cost[j] + beyond(j, n - 1) < cost[last] + beyond(last, n - 1)) last = j;
    std::vector<double> out;
    for (std::size_t j = last; j < n; j = from[j]) out.push_back(triggers[j]);
    std::reverse(out.begin(), out.end());
    return out.size() >= 2 ? out : triggers;
}

BeatClock::BeatClock(const Dataset& data) {
    const auto& triggers = data.heart.beat_times_s;
    std::vector<std::vector<double>> all;
    for (const std::vector<double>& run : triggers) {
        all.push_back(run.size() >= 2 ? beats_among(run) : run);
        dropped_ += run.size() - all.back().size();
    }
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
