#include "task/smoothness.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <vector>

#include "core/check.h"
#include "core/deterministic_math.h"
#include "core/units.h"

namespace cathlab {
namespace {

constexpr double cutoff_hz = 10.0;
constexpr double least_amplitude = 0.05;

/// In place, forward, length a power of two (Cooley and Tukey, radix 2, decimation in time).
void fourier_transform(std::vector<std::complex<double>>& a) {
    const std::size_t n = a.size();
    for (std::size_t i = 1, j = 0; i < n; ++i) {
        std::size_t bit = n >> 1U;
        for (; (j & bit) != 0; bit >>= 1U) j ^= bit;
        j ^= bit;
        if (i < j) std::swap(a[i], a[j]);
    }
    std::vector<std::complex<double>> turn(n / 2);
    for (std::size_t k = 0; k < n / 2; ++k) {
        const double angle = -2.0 * units::pi * static_cast<double>(k) / static_cast<double>(n);
        turn[k] = {det::cos(angle), det::sin(angle)};
    }
    for (std::size_t length = 2; length <= n; length *= 2) {
        const std::size_t stride = n / length;
        for (std::size_t start = 0; start < n; start += length) {
            for (std::size_t k = 0; k < length / 2; ++k) {
                const std::complex<double> w = turn[k * stride];
                const std::complex<double> b = a[start + k + length / 2];
                // Written out: the library's complex product may branch on NaN and differ between builds.
                const std::complex<double> t(w.real() * b.real() - w.imag() * b.imag(),
                                             w.real() * b.imag() + w.imag() * b.real());
                a[start + k + length / 2] = a[start + k] - t;
                a[start + k] += t;
            }
        }
    }
}

bool nothing_to_judge(std::span<const double> speed) {
    return speed.size() < 4 || std::all_of(speed.begin(), speed.end(), [](double v) { return v == 0.0; });
}

/// Symmetric windowed sinc; the ends are continued by their last value.
std::vector<double> low_pass(std::span<const double> v, double dt) {
    const double fraction = cutoff_hz * dt;  // of the sampling rate; at 0.5 and above there is nothing to take away
    if (fraction >= 0.5) return {v.begin(), v.end()};
    const auto half = static_cast<std::ptrdiff_t>(std::ceil(2.0 / fraction));
    std::vector<double> kernel(static_cast<std::size_t>(half) + 1);
    double sum = 0.0;
    for (std::ptrdiff_t k = 0; k <= half; ++k) {
        const double x = 2.0 * units::pi * fraction * static_cast<double>(k);
        const double sinc = k == 0 ? 1.0 : det::sin(x) / x;
        const double hann = 0.5 + 0.5 * det::cos(units::pi * static_cast<double>(k) / static_cast<double>(half + 1));
        kernel[static_cast<std::size_t>(k)] = sinc * hann;
        sum += (k == 0 ? 1.0 : 2.0) * sinc * hann;
    }
    const auto n = static_cast<std::ptrdiff_t>(v.size());
    std::vector<double> out(v.size());
    for (std::ptrdiff_t i = 0; i < n; ++i) {
        double value = 0.0;
        for (std::ptrdiff_t k = -half; k <= half; ++k)
            value += kernel[static_cast<std::size_t>(std::abs(k))] *
                     v[static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(i + k, 0, n - 1))];
        out[static_cast<std::size_t>(i)] = value / sum;
    }
    return out;
}

}  // namespace

double spectral_arc_length(std::span<const double> speed, double dt) {
    CATHLAB_CHECK(dt > 0.0, "samples must be apart in time");
    if (nothing_to_judge(speed)) return 0.0;
    std::size_t n = 16;
    while (n < 16 * speed.size()) n *= 2;
    std::vector<std::complex<double>> spectrum(n);
    std::copy(speed.begin(), speed.end(), spectrum.begin());
    fourier_transform(spectrum);
    const double step_hz = 1.0 / (static_cast<double>(n) * dt);
    std::vector<double> amplitude;
    for (std::size_t k = 0; k <= n / 2 && static_cast<double>(k) * step_hz <= cutoff_hz; ++k)
        amplitude.push_back(std::sqrt(std::norm(spectrum[k])));
    const double at_zero = amplitude.front();  // a speed is not negative: its largest amplitude
    std::size_t last = amplitude.size() - 1;
    while (last > 0 && amplitude[last] < least_amplitude * at_zero) --last;
    if (last == 0) return 0.0;
    double length = 0.0;
    for (std::size_t k = 1; k <= last; ++k) {
        const double rise = (amplitude[k] - amplitude[k - 1]) / at_zero;
        const double run = 1.0 / static_cast<double>(last);
        length += std::sqrt(run * run + rise * rise);
    }
    return -length;
}

double log_dimensionless_jerk(std::span<const double> speed, double dt) {
    CATHLAB_CHECK(dt > 0.0, "samples must be apart in time");
    if (nothing_to_judge(speed)) return 0.0;
    const std::vector<double> v = low_pass(speed, dt);
    double integral = 0.0;
    for (std::size_t i = 1; i + 1 < v.size(); ++i) {
        const double second = (v[i + 1] - 2.0 * v[i] + v[i - 1]) / (dt * dt);
        integral += second * second * dt;
    }
    const double peak = *std::max_element(v.begin(), v.end());
    const double duration = dt * static_cast<double>(v.size() - 1);
    const double jerk = duration * duration * duration / (peak * peak) * integral;
    return jerk > 0.0 ? -det::log(jerk) : 0.0;
}

}  // namespace cathlab
