#include "core/random.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <vector>

using namespace cathlab;

TEST(Random, UniformNumbersHaveTheMomentsOfAUniformDistribution) {
    const int n = 200000;
    double sum = 0.0, squares = 0.0, product = 0.0, previous = 0.0;
    for (int i = 0; i < n; ++i) {
        const double u = random_uniform(42, RandomStream::test, 0, static_cast<std::uint64_t>(i));
        ASSERT_GE(u, 0.0);
        ASSERT_LT(u, 1.0);
        sum += u;
        squares += u * u;
        product += (u - 0.5) * (previous - 0.5);
        previous = u;
    }
    // Five standard errors.
    EXPECT_NEAR(sum / n, 0.5, 5.0 * std::sqrt(1.0 / 12.0 / n));
    EXPECT_NEAR(squares / n, 1.0 / 3.0, 5.0 * std::sqrt(4.0 / 45.0 / n));
    EXPECT_NEAR(product / n, 0.0, 5.0 / 12.0 / std::sqrt(n));
}

TEST(Random, NormalNumbersHaveTheMomentsOfANormalDistribution) {
    const int n = 200000;
    double sum = 0.0, squares = 0.0, cubes = 0.0, fourths = 0.0;
    for (int i = 0; i < n; ++i) {
        const double x = random_normal(42, RandomStream::test, 1, static_cast<std::uint64_t>(i));
        sum += x;
        squares += x * x;
        cubes += x * x * x;
        fourths += x * x * x * x;
    }
    EXPECT_NEAR(sum / n, 0.0, 5.0 / std::sqrt(n));
    EXPECT_NEAR(squares / n, 1.0, 5.0 * std::sqrt(2.0 / n));
    EXPECT_NEAR(cubes / n, 0.0, 5.0 * std::sqrt(15.0 / n));
    EXPECT_NEAR(fourths / n, 3.0, 5.0 * std::sqrt(96.0 / n));
}

TEST(Random, EverySeedStreamStepAndIndexHasItsOwnNumbers) {
    std::set<std::uint64_t> seen;
    for (const std::uint64_t seed : {0ULL, 1ULL, 2ULL})
        for (const RandomStream stream : {RandomStream::quantum_noise, RandomStream::effect, RandomStream::test})
            for (std::uint64_t step = 0; step < 20; ++step)
                for (std::uint64_t index = 0; index < 20; ++index) seen.insert(random_bits(seed, stream, step, index));
    EXPECT_EQ(seen.size(), 3U * 3U * 20U * 20U);
}

TEST(Random, NeighbouringKeysAreNotCorrelated) {
    for (const int which : {0, 1}) {
        const int n = 100000;
        double product = 0.0;
        for (int i = 0; i < n; ++i) {
            const auto k = static_cast<std::uint64_t>(i);
            const double a = random_uniform(7, RandomStream::test, k, 3) - 0.5;
            const double b = (which == 0 ? random_uniform(7, RandomStream::test, k + 1, 3)
                                         : random_uniform(8, RandomStream::test, k, 3)) -
                             0.5;
            product += a * b;
        }
        EXPECT_NEAR(product / n, 0.0, 5.0 / 12.0 / std::sqrt(n));
    }
}

TEST(Random, TheNumbersAreAsTheyWere) {
    EXPECT_EQ(random_bits(1, RandomStream::test, 2, 3), 17677791403932922935ULL);
    EXPECT_EQ(random_uniform(1, RandomStream::test, 2, 3), random_uniform(1, RandomStream::test, 2, 3));
}
