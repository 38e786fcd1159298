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

namespace {

/// Values without gaps, their mean taken away, and the range of periods that they can show.
struct Signal {
    std::vector<double> t, v;
    std::vector<std::size_t> ends;  // of the parts that have a phase of their own
    double shortest = 0.0, longest = 0.0, variance = 0.0;
    bool usable = false;
};

Signal signal_of(std::span<const double> time_s, std::span<const double> values, std::span<const Index> run) {
    CATHLAB_CHECK(time_s.size() == values.size() && run.size() == values.size(), "one time and run a value");
    Signal out;
    std::vector<double> steps;
    double first = 0.0;
    for (std::size_t i = 0; i < values.size(); ++i) {
        if (i == 0 || run[i] != run[i - 1]) {
            first = time_s[i];
            if (i > 0) out.ends.push_back(out.v.size());
        } else {
            steps.push_back(time_s[i] - time_s[i - 1]);
        }
        out.longest = std::max(out.longest, time_s[i] - first);
        if (std::isnan(values[i])) continue;
        out.t.push_back(time_s[i]);
        out.v.push_back(values[i]);
    }
    if (out.v.size() < 8 || steps.empty() || out.longest <= 0.0) return out;
    out.shortest = 2.0 * median_of(steps);
    out.ends.push_back(out.v.size());
    constexpr std::size_t rows_a_part = 40;
    if (out.v.size() < rows_a_part * out.ends.size()) out.ends = {out.v.size()};
    std::size_t begin = 0;
    for (const std::size_t end : out.ends) {
        double mean = 0.0;
        for (std::size_t i = begin; i < end; ++i) mean += out.v[i] / static_cast<double>(end - begin);
        for (std::size_t i = begin; i < end; ++i) {
            out.v[i] -= mean;
            out.variance += out.v[i] * out.v[i];
        }
        begin = end;
    }
    out.usable = out.variance > 0.0 && out.shortest > 0.0 && out.shortest < out.longest;
    return out;
}

}  // namespace

std::vector<SpectrumPeak> highest_peaks(std::span<const double> time_s, std::span<const double> values,
                                        std::span<const Index> run, double shortest_s, double longest_s,
                                        std::size_t count) {
    const Signal signal = signal_of(time_s, values, run);
    if (!signal.usable) return {};
    const double shortest = std::max(signal.shortest, shortest_s), longest = std::min(signal.longest, longest_s);
    if (shortest >= longest) return {};
    // Four frequencies a width of the peak; never so many that the sums take long.
    const double step_hz = std::max(0.25 / signal.longest, (1.0 / shortest - 1.0 / longest) / 20000.0);
    const std::size_t n = signal.t.size();
    // The sine and cosine of every row turn from frequency to frequency by the same angle.
    std::vector<double> c(n), s(n), dc(n), ds(n);
    for (std::size_t i = 0; i < n; ++i) {
        const double w = 2.0 * units::pi * signal.t[i];
        c[i] = std::cos(w / longest);
        s[i] = std::sin(w / longest);
        dc[i] = std::cos(w * step_hz);
        ds[i] = std::sin(w * step_hz);
    }
    const int last = static_cast<int>((1.0 / shortest - 1.0 / longest) / step_hz);
    std::vector<SpectrumPeak> spectrum;
    for (int k = 0; k <= last; ++k) {
        SpectrumPeak here;
        here.period_s = 1.0 / (1.0 / longest + k * step_hz);
        std::size_t i = 0;
        for (const std::size_t end : signal.ends) {
            const std::size_t begin = i;
            double vc = 0.0, vs = 0.0, cc = 0.0, ss = 0.0, cs = 0.0;
            for (; i < end; ++i) {
                vc += signal.v[i] * c[i];
                vs += signal.v[i] * s[i];
                cc += c[i] * c[i];
                ss += s[i] * s[i];
                cs += c[i] * s[i];
                const double next = c[i] * dc[i] - s[i] * ds[i];
                s[i] = s[i] * dc[i] + c[i] * ds[i];
                c[i] = next;
            }
            // The least squares of a cosine and a sine: the same height as Lomb's with his shift.
            const double d = cc * ss - cs * cs;
            if (d > 1e-9 * cc * ss + 1e-300) {
                const double a = (vc * ss - vs * cs) / d, b = (vs * cc - vc * cs) / d;
                here.explained += (a * vc + b * vs) / signal.variance;
                here.amplitude += (a * a + b * b) * static_cast<double>(end - begin) / static_cast<double>(n);
            }
        }
        here.amplitude = std::sqrt(here.amplitude);
        spectrum.push_back(here);
    }
    std::vector<SpectrumPeak> out;
    for (std::size_t k = 0; k < spectrum.size(); ++k) {
        const bool rises = k == 0 || spectrum[k].explained >= spectrum[k - 1].explained;
        const bool falls = k + 1 == spectrum.size() || spectrum[k].explained > spectrum[k + 1].explained;
        if (rises && falls) out.push_back(spectrum[k]);
    }
    std::sort(out.begin(), out.end(),
              [](const SpectrumPeak& a, const SpectrumPeak& b) { return a.explained > b.explained; });
    if (out.size() > count) out.resize(count);
    const double independent = std::max(1.0, static_cast<double>(last + 1) * step_hz * signal.longest);
    for (SpectrumPeak& peak : out) {
        // Normalised power z = part * n / 2 is exponential for white noise (Scargle 1982, eq. 14, 22); the sum of that
        // of several parts has the tail exp(-z) sum_k z^k / k!.
        const double z = 0.5 * peak.explained * static_cast<double>(n);
        double tail = 0.0, term = std::exp(-z);
        for (std::size_t part = 1; part <= signal.ends.size(); ++part) {
            tail += term;
            term *= z / static_cast<double>(part);
        }
        peak.false_alarm = -std::expm1(independent * std::log1p(-std::min(tail, 1.0 - 1e-12)));
    }
    return out;
}

SpectrumPeak highest_peak(std::span<const double> time_s, std::span<const double> values, std::span<const Index> run) {
    const auto peaks = highest_peaks(time_s, values, run, 0.0, std::numeric_limits<double>::infinity(), std::size_t{1});
    return peaks.empty() ? SpectrumPeak{} : peaks[0];
}

}  // namespace cathlab
