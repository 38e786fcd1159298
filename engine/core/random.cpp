#include "core/random.h"

#include <cmath>

#include "core/deterministic_math.h"
#include "core/units.h"

namespace cathlab {
namespace {

constexpr std::uint64_t mix(std::uint64_t z) {
    z += 0x9E3779B97F4A7C15ULL;
    z = (z ^ (z >> 30U)) * 0xBF58476D1CE4E5B9ULL;
    z = (z ^ (z >> 27U)) * 0x94D049BB133111EBULL;
    return z ^ (z >> 31U);
}

double to_unit(std::uint64_t bits) {
    return static_cast<double>(bits >> 11U) * 0x1.0p-53;
}

}  // namespace

std::uint64_t random_bits(std::uint64_t seed, RandomStream stream, std::uint64_t step, std::uint64_t index) {
    return mix(mix(mix(mix(seed) ^ static_cast<std::uint64_t>(stream)) ^ step) ^ index);
}

double random_uniform(std::uint64_t seed, RandomStream stream, std::uint64_t step, std::uint64_t index) {
    return to_unit(random_bits(seed, stream, step, index));
}

double random_normal(std::uint64_t seed, RandomStream stream, std::uint64_t step, std::uint64_t index) {
    const std::uint64_t bits = random_bits(seed, stream, step, index);
    const double u = 1.0 - to_unit(bits);  // (0, 1]
    const double v = to_unit(mix(bits));
    return std::sqrt(-2.0 * det::log(u)) * det::cos(2.0 * units::pi * v);
}

}  // namespace cathlab
