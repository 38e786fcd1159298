#include "render/detector.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/check.h"
#include "core/units.h"
#include "render/pixel_loops.h"

namespace cathlab {

namespace {

constexpr std::size_t rows_per_task = 32;

template <class Body>
void for_rows(const ImageF& image, const Workers& workers, const Body& body) {
    workers.for_ranges(static_cast<std::size_t>(image.height), rows_per_task, [&](std::size_t begin, std::size_t end) {
        for (std::size_t y = begin; y < end; ++y) body(y);
    });
}

// SplitMix64's finaliser [steele2014].
inline std::uint64_t mixed(std::uint64_t z) {
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ULL;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBULL;
    return z ^ (z >> 31);
}

inline std::uint64_t frame_key(std::uint64_t seed, std::uint64_t frame, std::uint64_t stream) {
    return mixed(seed * 0x9E3779B97F4A7C15ULL + mixed(frame * 4 + stream + 0x632BE59BD9B4E019ULL));
}

// Taps whose transfer function is the Gaussian's, exp(-2 pi^2 sigma^2 f^2), up to the picture's Nyquist frequency:
//     h[n] = integral of exp(-2 pi^2 sigma^2 f^2) cos(2 pi n f) over f = -1/2..1/2 cycles a pixel.
// From sigma = 1 on these are the Gaussian's own samples; below, samples would blur too little (at sigma = 0.5 and a
// third of a cycle a pixel they let through 0.70 where the Gaussian lets through 0.58).
std::vector<float> gaussian(double sigma) {
    constexpr int steps = 400;
    const int radius = std::max(5, static_cast<int>(std::ceil(3 * sigma)));
    const double per = 2 * units::pi * units::pi * sigma * sigma;
    std::vector<double> taps;
    taps.reserve(2 * static_cast<std::size_t>(radius) + 1);
    double sum = 0;
    for (int n = -radius; n <= radius; ++n) {
        double integral = 0;  // trapezoid over half of the even function
        for (int k = 0; k <= steps; ++k) {
            const double f = 0.5 * k / steps;
            integral += (k == 0 || k == steps ? 0.5 : 1.0) * std::exp(-per * f * f) * std::cos(2 * units::pi * n * f);
        }
        taps.push_back(integral / steps);
        sum += taps.back();
    }
    std::vector<float> kernel;
    for (const double tap : taps) kernel.push_back(static_cast<float>(tap / sum));
    return kernel;
}

}  // namespace

float pixel_noise(std::uint64_t seed, std::uint64_t frame, std::uint64_t pixel, std::uint64_t stream) {
    return pixel_loops::normal_of(frame_key(seed, frame, stream), static_cast<std::uint32_t>(pixel));
}

void add_quantum_noise(ImageF& photons, std::uint64_t seed, std::uint64_t frame, const Workers& workers) {
    const std::uint64_t key = frame_key(seed, frame, 0);
    const auto width = static_cast<std::size_t>(photons.width);
    const pixel_loops::Set& loops = pixel_loops::best();
    for_rows(photons, workers, [&](std::size_t y) {
        loops.quantum_noise(key, static_cast<std::uint32_t>(y * width), width, photons.values.data() + y * width);
    });
}

void add_electronic_noise(ImageF& photons, double sigma, std::uint64_t seed, std::uint64_t frame,
                          const Workers& workers) {
    if (sigma <= 0) return;
    const std::uint64_t key = frame_key(seed, frame, 1);
    const auto s = static_cast<float>(sigma);
    const auto width = static_cast<std::size_t>(photons.width);
    const pixel_loops::Set& loops = pixel_loops::best();
    for_rows(photons, workers, [&](std::size_t y) {
        loops.electronic_noise(key, s, static_cast<std::uint32_t>(y * width), width, photons.values.data() + y * width);
    });
}

void blur(ImageF& image, double sigma_px, const Workers& workers) {
    GaussianBlur().apply(image, sigma_px, workers);
}

void GaussianBlur::apply(ImageF& image, double sigma_px, const Workers& workers) {
    if (sigma_px < 0.15) return;
    if (sigma_px != sigma_px_) {
        kernel_ = gaussian(sigma_px);
        sigma_px_ = sigma_px;
    }
    const std::size_t taps = kernel_.size(), radius = taps / 2;
    const auto width = static_cast<std::size_t>(image.width);
    const auto height = static_cast<std::size_t>(image.height);
    // Rows of a width that is a power of two would all fall on the same lines of the cache.
    const std::size_t stride = width + 24;
    across_.resize(stride * height);
    const pixel_loops::Set& loops = pixel_loops::best();
    workers.for_ranges(height, rows_per_task, [&](std::size_t begin, std::size_t end) {
        std::vector<float> padded(width + 2 * radius);
        std::vector<const float*> shifted(taps);
        for (std::size_t k = 0; k < taps; ++k) shifted[k] = padded.data() + k;
        for (std::size_t y = begin; y < end; ++y) {
            const float* row = image.values.data() + y * width;
            std::copy(row, row + width, padded.begin() + static_cast<std::ptrdiff_t>(radius));
            std::fill_n(padded.begin(), radius, row[0]);
            std::fill_n(padded.end() - static_cast<std::ptrdiff_t>(radius), radius, row[width - 1]);
            loops.weigh(shifted.data(), kernel_.data(), taps, width, across_.data() + y * stride);
        }
    });
    workers.for_ranges(height, rows_per_task, [&](std::size_t begin, std::size_t end) {
        std::vector<const float*> rows(taps);
        for (std::size_t y = begin; y < end; ++y) {
            for (std::size_t k = 0; k < taps; ++k) {
                const std::size_t from = std::min(height - 1, y + k > radius ? y + k - radius : 0);
                rows[k] = across_.data() + from * stride;
            }
            loops.weigh(rows.data(), kernel_.data(), taps, width, image.values.data() + y * width);
        }
    });
}

void recurse(ImageF& history, const ImageF& x, double b, const Workers& workers) {
    CATHLAB_CHECK(b >= 0 && b < 1, "recursion factor out of [0, 1)");
    if (history.width != x.width || history.height != x.height) {
        history = x;
        return;
    }
    const auto keep = static_cast<float>(b);
    const auto width = static_cast<std::size_t>(x.width);
    for_rows(x, workers, [&](std::size_t y) {
        float* old = history.values.data() + y * width;
        const float* now = x.values.data() + y * width;
        for (std::size_t i = 0; i < width; ++i) old[i] = now[i] + keep * (old[i] - now[i]);
    });
}

ImageF wide_blur(const ImageF& image, double sigma_px, const Workers& workers) {
    // Means over blocks of a fifth of sigma, a Gaussian on those, and bilinear interpolation back.
    const int block = std::max(1, static_cast<int>(sigma_px / 5));
    ImageF coarse((image.width + block - 1) / block, (image.height + block - 1) / block);
    workers.for_ranges(static_cast<std::size_t>(coarse.height), 1, [&](std::size_t begin, std::size_t end) {
        for (auto cy = static_cast<int>(begin); cy < static_cast<int>(end); ++cy) {
            for (int cx = 0; cx < coarse.width; ++cx) {
                double sum = 0;
                int count = 0;
                for (int y = cy * block; y < std::min(image.height, (cy + 1) * block); ++y) {
                    for (int x = cx * block; x < std::min(image.width, (cx + 1) * block); ++x, ++count)
                        sum += image.at(x, y);
                }
                coarse.values[coarse.offset(cx, cy)] = static_cast<float>(sum / count);
            }
        }
    });
    blur(coarse, sigma_px / block, Workers());
    struct Between {
        std::size_t first;
        float share;
    };
    const auto between = [&](int at, int count) {
        const double f = std::clamp((at + 0.5) / block - 0.5, 0.0, count - 1.0);
        const int first = std::min(static_cast<int>(f), std::max(0, count - 2));
        return Between{static_cast<std::size_t>(first), static_cast<float>(f - first)};
    };
    std::vector<Between> columns;
    columns.reserve(static_cast<std::size_t>(image.width));
    for (int x = 0; x < image.width; ++x) columns.push_back(between(x, coarse.width));
    const std::size_t next = coarse.width > 1 ? 1 : 0;
    ImageF out(image.width, image.height);
    for_rows(out, workers, [&](std::size_t y) {
        const Between row = between(static_cast<int>(y), coarse.height);
        const auto coarse_width = static_cast<std::size_t>(coarse.width);
        const float* upper = coarse.values.data() + row.first * coarse_width;
        const float* lower = coarse.height > 1 ? upper + coarse_width : upper;
        float* to = out.values.data() + y * columns.size();
        for (const auto& [first, share] : columns) {
            const float top = upper[first] + share * (upper[first + next] - upper[first]);
            const float low = lower[first] + share * (lower[first + next] - lower[first]);
            *to++ = top + row.share * (low - top);
        }
    });
    return out;
}

}  // namespace cathlab
