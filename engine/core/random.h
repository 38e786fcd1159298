// Random numbers without state: a pure function of (seed, stream, step, index).
// The mixing is SplitMix64's finaliser (Steele, Lea and Flood 2014) over the four words.
#pragma once

#include <cstdint>

namespace cathlab {

/// Names of the streams, so that no two users of the same seed draw the same numbers.
enum class RandomStream : std::uint64_t {
    quantum_noise = 1,
    electronic_noise = 2,
    sampling = 3,
    effect = 4,
    operator_ = 5,
    optimiser = 6,
    test = 7
};

/// 64 random bits.
std::uint64_t random_bits(std::uint64_t seed, RandomStream stream, std::uint64_t step, std::uint64_t index);

/// Uniform in [0, 1), 53 bits.
double random_uniform(std::uint64_t seed, RandomStream stream, std::uint64_t step, std::uint64_t index);

/// Standard normal (Box-Muller on two uniforms of the same key, deterministic sin/cos/log).
double random_normal(std::uint64_t seed, RandomStream stream, std::uint64_t step, std::uint64_t index);

}  // namespace cathlab
