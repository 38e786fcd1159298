// The fluoroscopy's loops over pixels, compiled for each instruction set that helps.  The same operations on each pixel
// in the same order: the values do not depend on the copy.  For this room's .cpp files only.
#pragma once

#include <cstddef>
#include <cstdint>

namespace cathlab::pixel_loops {

inline constexpr std::size_t bins = 8;  // of energy

/// Something in the rays' way: how much of it on each, mm (or mm mg/mL), and its attenuation in each bin.
struct Absorber {
    const float* amount;
    const float* mu;  ///< (bins)
};

/// Where rays of a row meet a plane: 1 / depth = per_slope * slope + at_zero, held within [least, most].
struct PlaneInRow {
    double per_slope, at_zero, least, most;
    double reference;  ///< that is taken off the depth
    float sign;        ///< 1 leaving, -1 entering
};

struct Set {
    const char* name;
    /// depth += sign (1 / (...) - reference), exits += sign, of the pixels whose rays have these slopes.
    void (*add_depths)(const double* slope, std::size_t count, const PlaneInRow& plane, float* depth, float* exits);
    /// transmission[bins * i + k] = geometry_i weight_k exp(-sum of mu_k amount_i); out = its sum over the bins.
    void (*pass_context)(const Absorber* absorbers, std::size_t absorber_count, const float* weights,
                         const float* geometry, std::size_t begin, std::size_t end, float* transmission, float* out);
    /// out = sum over k of weights_k rows_k: one pass of a separable blur.
    void (*weigh)(const float* const* rows, const float* weights, std::size_t taps, std::size_t count, float* out);
    /// transmission * exp(-exponent) in place of each exponent.
    void (*attenuate)(const float* transmission, std::size_t count, float* exponent);
    /// out = sum over bins of transmission[bins * i + k] exp(-sum of mu_k amount_i), plus scatter: Beer-Lambert.  Where
    /// there is nothing in the way, untouched + scatter.
    void (*absorb)(const Absorber* absorbers, std::size_t absorber_count, const float* transmission,
                   const float* untouched, const float* scatter, std::size_t begin, std::size_t end, float* out);
    /// n + sqrt(n) * normal, at least 0, of pixels first, first + 1, ...
    void (*quantum_noise)(std::uint64_t key, std::uint32_t first, std::size_t count, float* photons);
    /// n + sigma * normal.
    void (*electronic_noise)(std::uint64_t key, float sigma, std::uint32_t first, std::size_t count, float* photons);
    /// log of the intensity relative to the wanted one, less a share of the coarse picture.
    void (*to_log)(const float* history, const float* coarse, float unit, float even, float mean, std::size_t count,
                   float* out);
    /// A row with its edges enhanced, as grey in [0, 255].  padded: one more value at each end.
    void (*sharpen)(const float* padded, const float* above, const float* below, float edge, float scale, float offset,
                    std::size_t count, std::uint8_t* out);
};

const Set& baseline();
/// Null where the processor has none.
const Set* avx2();
const Set& best();

/// Mean 0, variance 1: the sum of four uniforms of 16 bits (Irwin-Hall) from two words, each MurmurHash3's 32-bit
/// finaliser of the pixel [appleby2016] under one half of the key.
inline float normal_of(std::uint64_t key, std::uint32_t pixel) {
    const auto mixed = [](std::uint32_t h) {
        h = (h ^ (h >> 16)) * 0x85EBCA6BU;
        h = (h ^ (h >> 13)) * 0xC2B2AE35U;
        return h ^ (h >> 16);
    };
    const std::uint32_t a = mixed(pixel * 0x9E3779B1U + static_cast<std::uint32_t>(key));
    const std::uint32_t b = mixed(a ^ static_cast<std::uint32_t>(key >> 32));
    const auto sum = static_cast<std::int32_t>((a & 0xFFFFU) + (a >> 16) + (b & 0xFFFFU) + (b >> 16));
    // Variance of one uniform on 0..65535 is (65536^2 - 1) / 12.
    return static_cast<float>(sum - 131070) * (1.7320508F / 65536.0F);
}

}  // namespace cathlab::pixel_loops
