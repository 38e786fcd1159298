#include "core/deterministic_math.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>

#include "core/hash.h"
#include "core/random.h"
#include "core/units.h"

using namespace cathlab;

namespace {

constexpr double inf = std::numeric_limits<double>::infinity();

/// Distance in units of the last place of the expected number (of the smallest normal number where that is less).
double ulps(double found, double expected) {
    if (found == expected) return 0.0;
    const double a = std::max(std::fabs(expected), std::numeric_limits<double>::min());
    return std::fabs(found - expected) / (std::nextafter(a, inf) - a);
}

/// The long double function is the measure: it is good to 1e-19 on x86-64.
template <class Found, class Expected>
double worst_ulps(double low, double high, std::uint64_t stream, Found found, Expected expected) {
    double worst = 0.0;
    for (std::uint64_t i = 0; i < 200000; ++i) {
        const double x = low + (high - low) * random_uniform(1, RandomStream::test, stream, i);
        worst = std::max(worst, ulps(found(x), static_cast<double>(expected(static_cast<long double>(x)))));
    }
    return worst;
}

}  // namespace

TEST(DeterministicMath, SineAndCosineAreGoodToTwoUlp) {
    const auto sine = [](long double x) { return std::sin(x); };
    const auto cosine = [](long double x) { return std::cos(x); };
    for (const double range : {1e-3, 1.0, 10.0, 1000.0}) {
        EXPECT_LE(worst_ulps(-range, range, 1, det::sin, sine), 2.0) << range;
        EXPECT_LE(worst_ulps(-range, range, 2, det::cos, cosine), 2.0) << range;
    }
    // Farther out the argument's own reduction costs digits next to the zeros: the error stays absolute.
    for (std::uint64_t i = 0; i < 100000; ++i) {
        const double x = 1e5 * (2.0 * random_uniform(1, RandomStream::test, 3, i) - 1.0);
        EXPECT_NEAR(det::sin(x), static_cast<double>(std::sin(static_cast<long double>(x))), 4e-16);
        EXPECT_NEAR(det::cos(x), static_cast<double>(std::cos(static_cast<long double>(x))), 4e-16);
    }
}

TEST(DeterministicMath, SineIsGoodNextToItsZeros) {
    for (int k = -40; k <= 40; ++k) {
        const double x = k * units::pi;  // not a zero: off by the rounding of k pi, which is what sin must return
        EXPECT_LE(ulps(det::sin(x), static_cast<double>(std::sin(static_cast<long double>(x)))), 2.0) << k;
    }
}

TEST(DeterministicMath, ExpAndLogAreGoodToTwoUlp) {
    const auto exponential = [](long double x) { return std::exp(x); };
    const auto logarithm = [](long double x) { return std::log(x); };
    for (const double range : {1e-6, 1.0, 50.0, 700.0})
        EXPECT_LE(worst_ulps(-range, range, 4, det::exp, exponential), 2.0) << range;
    EXPECT_LE(worst_ulps(0.5, 2.0, 5, det::log, logarithm), 2.0);
    EXPECT_LE(worst_ulps(1e-300, 1e-290, 6, det::log, logarithm), 2.0);
    EXPECT_LE(worst_ulps(1e3, 1e300, 7, det::log, logarithm), 2.0);
}

TEST(DeterministicMath, ArcFunctionsAreGoodToTheUlpThatTheHeaderStates) {
    for (const double range : {1e-4, 1.0, 20.0, 1e6})
        EXPECT_LE(worst_ulps(-range, range, 8, det::atan, [](long double x) { return std::atan(x); }), 2.0) << range;
    EXPECT_LE(worst_ulps(-1.0, 1.0, 9, det::asin, [](long double x) { return std::asin(x); }), 4.0);
    EXPECT_LE(worst_ulps(-1.0, 1.0, 10, det::acos, [](long double x) { return std::acos(x); }), 4.0);
}

TEST(DeterministicMath, AtanOfTwoKnowsItsQuadrant) {
    for (std::uint64_t i = 0; i < 100000; ++i) {
        const double y = 2.0 * random_uniform(1, RandomStream::test, 11, i) - 1.0;
        const double x = 2.0 * random_uniform(1, RandomStream::test, 12, i) - 1.0;
        EXPECT_LE(ulps(det::atan2(y, x), std::atan2(y, x)), 4.0) << y << " " << x;
    }
    EXPECT_EQ(det::atan2(0.0, 1.0), 0.0);
    EXPECT_EQ(det::atan2(0.0, -1.0), units::pi);
    EXPECT_EQ(det::atan2(1.0, 0.0), units::pi / 2.0);
    EXPECT_EQ(det::atan2(-1.0, 0.0), -units::pi / 2.0);
    EXPECT_EQ(det::atan2(0.0, 0.0), 0.0);
}

TEST(DeterministicMath, PowersKeepRelativeDigits) {
    for (std::uint64_t i = 0; i < 50000; ++i) {
        const double x = 1e-3 + 50.0 * random_uniform(1, RandomStream::test, 13, i);
        const double y = 8.0 * random_uniform(1, RandomStream::test, 14, i) - 4.0;
        EXPECT_NEAR(det::pow(x, y) / std::pow(x, y), 1.0, 1e-14);
    }
    EXPECT_EQ(det::pow(0.0, 2.0), 0.0);
    EXPECT_EQ(det::pow(7.0, 0.0), 1.0);
}

TEST(DeterministicMath, EdgesGiveWhatTheHeaderSays) {
    for (const double x : {inf, -inf, std::nan("")}) {
        EXPECT_TRUE(std::isnan(det::sin(x)));
        EXPECT_TRUE(std::isnan(det::cos(x)));
    }
    EXPECT_EQ(det::sin(0.0), 0.0);
    EXPECT_EQ(det::cos(0.0), 1.0);
    EXPECT_EQ(det::exp(0.0), 1.0);
    EXPECT_EQ(det::exp(inf), inf);
    EXPECT_EQ(det::exp(-inf), 0.0);
    EXPECT_EQ(det::exp(-1000.0), 0.0);
    EXPECT_EQ(det::exp(1000.0), inf);
    EXPECT_LE(ulps(det::exp(709.0), std::exp(709.0)), 2.0);
    EXPECT_LE(ulps(det::exp(709.75), std::exp(709.75)), 2.0);
    EXPECT_GT(det::exp(-740.0), 0.0);  // subnormal
    EXPECT_EQ(det::log(1.0), 0.0);
    EXPECT_EQ(det::log(0.0), -inf);
    EXPECT_EQ(det::log(inf), inf);
    EXPECT_TRUE(std::isnan(det::log(-1.0)));
    EXPECT_LE(ulps(det::log(5e-324), std::log(5e-324)), 2.0);
    EXPECT_EQ(det::acos(1.0), 0.0);
    EXPECT_EQ(det::acos(2.0), 0.0);
    EXPECT_LE(ulps(det::acos(-5.0), units::pi), 1.0);
    EXPECT_LE(ulps(det::asin(1.5), units::pi / 2.0), 1.0);
    EXPECT_LE(ulps(det::atan(inf), units::pi / 2.0), 1.0);
}

TEST(DeterministicMath, TheBitsOfManyResultsAreAsTheyWere) {
    // A changed number here means that every recorded state hash is void: raise the recordings' format with it.
    Hash64 hash;
    for (std::uint64_t i = 0; i < 20000; ++i) {
        const double u = 2.0 * random_uniform(5, RandomStream::test, 15, i) - 1.0;
        for (const double v : {det::sin(20.0 * u), det::cos(20.0 * u), det::exp(30.0 * u), det::log(std::fabs(u)),
                               det::atan(5.0 * u), det::acos(u), det::pow(std::fabs(u), 1.7)})
            hash.word(std::bit_cast<std::uint64_t>(v));
    }
    EXPECT_EQ(hash_text(hash.value()), "93f2bf2eaae5e16b");
}

TEST(Rotation, VectorAndQuaternionAreInverse) {
    for (std::uint64_t i = 0; i < 20000; ++i) {
        Vec3 v;
        for (int k = 0; k < 3; ++k)
            v[k] = 2.0 * random_uniform(1, RandomStream::test, 16, 3 * i + static_cast<unsigned>(k)) - 1.0;
        v *= i % 3 == 0 ? 1e-9 : (i % 3 == 1 ? 1e-3 : 1.7);
        const Quat q = det::rotation_from_vector(v);
        EXPECT_NEAR(q.norm(), 1.0, 1e-15);
        EXPECT_LT((det::vector_from_rotation(q) - v).norm(), 1e-15 + 1e-14 * v.norm());
        EXPECT_LT((det::vector_from_rotation(Quat(-q.w(), -q.x(), -q.y(), -q.z())) - v).norm(),
                  1e-15 + 1e-14 * v.norm());
    }
    EXPECT_TRUE(det::rotation_from_vector(Vec3::Zero()).coeffs() == Quat::Identity().coeffs());
}

TEST(Rotation, ByAQuarterTurnsXIntoY) {
    const Quat q = det::rotation_from_vector(Vec3(0.0, 0.0, units::pi / 2.0));
    EXPECT_LT((q * Vec3::UnitX() - Vec3::UnitY()).norm(), 1e-15);
}

TEST(Rotation, BetweenTwoDirectionsTurnsTheOneIntoTheOther) {
    for (std::uint64_t i = 0; i < 2000; ++i) {
        Vec3 a, b;
        for (int k = 0; k < 3; ++k) {
            a[k] = random_normal(1, RandomStream::test, 17, 3 * i + static_cast<unsigned>(k));
            b[k] = random_normal(1, RandomStream::test, 18, 3 * i + static_cast<unsigned>(k));
        }
        a.normalize();
        b.normalize();
        if (i % 4 == 0) b = -a;
        if (i % 4 == 1) b = (-a + 1e-7 * b).normalized();
        EXPECT_LT((det::rotation_between(a, b) * a - b).norm(), 3e-8) << i;
    }
}
