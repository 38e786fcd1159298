#include "explain/residual.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/check.h"
#include "core/units.h"

namespace cathlab {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double median_to_deviation = 1.4826;  // of a normal distribution

double median_of(std::vector<double>& v) {
    if (v.empty()) return nan;
    const auto middle = v.begin() + static_cast<std::ptrdiff_t>(v.size() / 2);
    std::nth_element(v.begin(), middle, v.end());
    return *middle;
}

}  // namespace

double rms(std::span<const double> values, std::span<const std::uint8_t> flags, std::uint8_t flag) {
    double sum = 0.0;
    std::size_t count = 0;
    for (std::size_t i = 0; i < values.size(); ++i) {
        if (std::isnan(values[i]) || (!flags.empty() && flags[i] != flag)) continue;
        sum += values[i] * values[i];
        ++count;
    }
    return count > 0 ? std::sqrt(sum / static_cast<double>(count)) : nan;
}

double noise_by_differences(std::span<const double> values, std::span<const Index> run) {
    std::vector<double> second;
    for (std::size_t i = 1; i + 1 < values.size(); ++i) {
        const double d = values[i + 1] - 2.0 * values[i] + values[i - 1];
        if (run[i - 1] == run[i] && run[i] == run[i + 1] && !std::isnan(d)) second.push_back(std::fabs(d));
    }
    return median_to_deviation * median_of(second) / std::sqrt(6.0);
}

double lag_one_autocorrelation(std::span<const double> values, std::span<const Index> run) {
    double sum = 0.0;
    std::size_t count = 0;
    for (const double v : values)
        if (!std::isnan(v)) sum += v, ++count;
    if (count < 3) return nan;
    const double mean = sum / static_cast<double>(count);
    double product = 0.0, square = 0.0;
    for (std::size_t i = 0; i < values.size(); ++i) {
        if (std::isnan(values[i])) continue;
        square += (values[i] - mean) * (values[i] - mean);
        if (i > 0 && run[i] == run[i - 1] && !std::isnan(values[i - 1]))
            product += (values[i] - mean) * (values[i - 1] - mean);
    }
    return square > 0.0 ? product / square : 0.0;
}

double outlier_part(std::span<const double> values) {
    constexpr double far = 5.0;
    std::vector<double> known;
    std::copy_if(values.begin(), values.end(), std::back_inserter(known), [](double v) { return !std::isnan(v); });
    if (known.empty()) return 0.0;
    std::vector<double> work = known;
    const double middle = median_of(work);
    std::transform(known.begin(), known.end(), work.begin(), [&](double v) { return std::fabs(v - middle); });
    const std::vector<double> distance = work;
    const double deviation = median_to_deviation * median_of(work);
    if (deviation <= 0.0) return 0.0;
    const auto count = std::count_if(distance.begin(), distance.end(), [&](double d) { return d > far * deviation; });
    return static_cast<double>(count) / static_cast<double>(known.size());
}

SpectrumPeak highest_peak(std::span<const double> time_s, std::span<const double> values, std::span<const Index> run) {
    CATHLAB_CHECK(time_s.size() == values.size() && run.size() == values.size(), "one time and run a value");
    std::vector<double> t, v, steps;
    double shortest = 0.0, longest = 0.0, first = 0.0;
    for (std::size_t i = 0; i < values.size(); ++i) {
        if (i == 0 || run[i] != run[i - 1])
            first = time_s[i];
        else
            steps.push_back(time_s[i] - time_s[i - 1]);
        longest = std::max(longest, time_s[i] - first);
        if (std::isnan(values[i])) continue;
        t.push_back(time_s[i]);
        v.push_back(values[i]);
    }
    if (v.size() < 8 || steps.empty() || longest <= 0.0) return {};
    shortest = 2.0 * median_of(steps);
    double mean = 0.0;
    for (const double x : v) mean += x / static_cast<double>(v.size());
    double variance = 0.0;
    for (double& x : v) {
        x -= mean;
        variance += x * x;
    }
    if (variance <= 0.0 || shortest <= 0.0 || shortest >= longest) return {};
    // Four frequencies a width of the peak; never so many that the sums take long.
    const double step_hz = std::max(0.25 / longest, (1.0 / shortest - 1.0 / longest) / 20000.0);
    SpectrumPeak best;
    double independent = 0.0;
    const int last = static_cast<int>((1.0 / shortest - 1.0 / longest) / step_hz);
    for (int k = 0; k <= last; ++k) {
        const double f = 1.0 / longest + k * step_hz;
        const double w = 2.0 * units::pi * f;
        double s2 = 0.0, c2 = 0.0;
        for (const double x : t) {
            s2 += std::sin(2.0 * w * x);
            c2 += std::cos(2.0 * w * x);
        }
        const double shift = 0.5 * std::atan2(s2, c2);
        double c = 0.0, s = 0.0, cc = 0.0, ss = 0.0;
        for (std::size_t i = 0; i < t.size(); ++i) {
            const double a = w * t[i] - shift;
            const double cosine = std::cos(a), sine = std::sin(a);
            c += v[i] * cosine;
            s += v[i] * sine;
            cc += cosine * cosine;
            ss += sine * sine;
        }
        const double power = (cc > 1e-9 ? c * c / cc : 0.0) + (ss > 1e-9 ? s * s / ss : 0.0);
        if (power / variance > best.explained) {
            best.explained = power / variance;
            best.period_s = 1.0 / f;
            best.amplitude = std::hypot(cc > 1e-9 ? c / cc : 0.0, ss > 1e-9 ? s / ss : 0.0);
        }
        independent += step_hz * longest;
    }
    // Normalised power z = part * n / 2 is exponential for white noise (Scargle 1982, eq. 14, 22).
    const double z = 0.5 * best.explained * static_cast<double>(v.size());
    best.false_alarm = -std::expm1(independent * std::log1p(-std::exp(-z)));
    return best;
}

}  // namespace cathlab
