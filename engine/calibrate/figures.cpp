#include "calibrate/figures.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "core/check.h"

namespace cathlab {
namespace {

double percentile(const std::vector<double>& sorted, double share) {
    const double rank = share * static_cast<double>(sorted.size() - 1);
    const auto below = static_cast<std::size_t>(std::floor(rank));
    const std::size_t above = std::min(below + 1, sorted.size() - 1);
    return sorted[below] + (rank - static_cast<double>(below)) * (sorted[above] - sorted[below]);
}

struct Spread {
    double mean = 0.0, sd = 0.0;
};

Spread spread_of(std::span<const double> values) {
    const auto n = static_cast<double>(values.size());
    Spread out;
    for (const double v : values) out.mean += v / n;
    double squares = 0.0;
    for (const double v : values) squares += (v - out.mean) * (v - out.mean);
    out.sd = n > 1.0 ? std::sqrt(squares / (n - 1.0)) : 0.0;
    return out;
}

}  // namespace

Figures figures_of(std::span<const double> differences) {
    const bool usable = !differences.empty() &&
                        std::all_of(differences.begin(), differences.end(), [](double e) { return std::isfinite(e); });
    if (!usable) {
        constexpr double none = std::numeric_limits<double>::quiet_NaN();
        return {none, none, none, none, none, none, none, none};
    }
    std::vector<double> size;
    double squares = 0.0;
    for (const double e : differences) {
        size.push_back(std::fabs(e));
        squares += e * e;
    }
    Figures out;
    out.rmse = std::sqrt(squares / static_cast<double>(differences.size()));
    const Spread signed_spread = spread_of(differences);
    const Spread size_spread = spread_of(size);
    out.mean = signed_spread.mean;
    out.sd = signed_spread.sd;
    out.mean_absolute = size_spread.mean;
    out.sd_absolute = size_spread.sd;
    std::sort(size.begin(), size.end());
    out.median = percentile(size, 0.5);
    out.p90 = percentile(size, 0.9);
    out.maximum = size.back();
    return out;
}

Figures figures_of(std::span<const double> simulated, std::span<const double> reference) {
    CATHLAB_CHECK(simulated.size() == reference.size(), "both curves have the same points");
    std::vector<double> differences;
    for (std::size_t i = 0; i < simulated.size(); ++i) differences.push_back(simulated[i] - reference[i]);
    return figures_of(differences);
}

}  // namespace cathlab
