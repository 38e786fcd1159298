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
    if (sigma_px < 0.15) return;
    const std::vector<float> kernel = gaussian(sigma_px);
    const auto taps = kernel.size();
    const auto radius = taps / 2;
    const auto width = static_cast<std::size_t>(image.width);
    const auto height = static_cast<std::size_t>(image.height);
    ImageF across(image.width, image.height);
    for_rows(image, workers, [&](std::size_t y) {
        std::vector<float> padded(width + 2 * radius);
        const float* row = image.values.data() + y * width;
        std::copy(row, row + width, padded.begin() + static_cast<std::ptrdiff_t>(radius));
        std::fill_n(padded.begin(), radius, row[0]);
        std::fill_n(padded.end() - static_cast<std::ptrdiff_t>(radius), radius, row[width - 1]);
        float* out = across.values.data() + y * width;
        std::fill_n(out, width, 0.0F);
        for (std::size_t k = 0; k < taps; ++k) {
            const float weight = kernel[k];
            const float* in = padded.data() + k;
            for (std::size_t x = 0; x < width; ++x) out[x] += weight * in[x];
        }
    });
    for_rows(image, workers, [&](std::size_t y) {
        float* out = image.values.data() + y * width;
        std::fill_n(out, width, 0.0F);
        for (std::size_t k = 0; k < taps; ++k) {
            const std::size_t from = std::min(height - 1, y + k > radius ? y + k - radius : 0);
            const float weight = kernel[k];
            const float* in = across.values.data() + from * width;
            for (std::size_t x = 0; x < width; ++x) out[x] += weight * in[x];
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

ImageF wide_blur(const ImageF& image, double sigma_px) {
    // Means over blocks of a fifth of sigma, a Gaussian on those, and bilinear interpolation back.
    const int block = std::max(1, static_cast<int>(sigma_px / 5));
    ImageF coarse((image.width + block - 1) / block, (image.height + block - 1) / block);
    for (int cy = 0; cy < coarse.height; ++cy) {
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
    blur(coarse, sigma_px / block, Workers());
    ImageF out(image.width, image.height);
    for (int y = 0; y < image.height; ++y) {
        const double fy = std::clamp((y + 0.5) / block - 0.5, 0.0, coarse.height - 1.0);
        const int y0 = std::min(static_cast<int>(fy), std::max(0, coarse.height - 2));
        const int y1 = std::min(y0 + 1, coarse.height - 1);
        const auto ty = static_cast<float>(fy - y0);
        for (int x = 0; x < image.width; ++x) {
            const double fx = std::clamp((x + 0.5) / block - 0.5, 0.0, coarse.width - 1.0);
            const int x0 = std::min(static_cast<int>(fx), std::max(0, coarse.width - 2));
            const int x1 = std::min(x0 + 1, coarse.width - 1);
            const auto tx = static_cast<float>(fx - x0);
            const float top = coarse.at(x0, y0) + tx * (coarse.at(x1, y0) - coarse.at(x0, y0));
            const float low = coarse.at(x0, y1) + tx * (coarse.at(x1, y1) - coarse.at(x0, y1));
            out.values[out.offset(x, y)] = top + ty * (low - top);
        }
    }
    return out;
}

}  // namespace cathlab
