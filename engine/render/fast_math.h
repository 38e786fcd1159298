// Float exp and log for pixels: relative error below 3e-6, and simple enough for the compiler to do four at a time.
// Pictures never reach a state hash.
#pragma once

#include <bit>
#include <cstdint>

namespace cathlab {

inline float fast_exp(float x) {
    x = x < -87.0F ? -87.0F : (x > 87.0F ? 87.0F : x);
    const float t = x * 1.44269504F;
    const auto whole = static_cast<std::int32_t>(t + (t < 0 ? -0.5F : 0.5F));
    const float f = (t - static_cast<float>(whole)) * 0.69314718F;
    // Taylor polynomial of degree 6 on |f| <= ln(2) / 2: error below 2e-7.
    const float p =
        1.0F + f * (1.0F + f * (0.5F + f * (1.0F / 6 + f * (1.0F / 24 + f * (1.0F / 120 + f * (1.0F / 720))))));
    return p * std::bit_cast<float>((whole + 127) << 23);
}

/// x > 0, normal.
inline float fast_log(float x) {
    const auto bits = std::bit_cast<std::int32_t>(x);
    // Mantissa in [sqrt(1/2), sqrt(2)).
    const std::int32_t exponent = (bits - 0x3F3504F3) >> 23;
    const float m = std::bit_cast<float>(bits - (exponent << 23));
    const float s = (m - 1.0F) / (m + 1.0F);  // ln m = 2 atanh(s), |s| < 0.1716
    const float q = s * s;
    return static_cast<float>(exponent) * 0.69314718F +
           2.0F * s * (1.0F + q * (1.0F / 3 + q * (0.2F + q * (1.0F / 7))));
}

}  // namespace cathlab
