#include "task/smoothness.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

using namespace cathlab;

namespace {

/// Minimum-jerk reach of length 1 in T seconds: v = 30 s^2 (1 - s)^2 / T, s = t / T.
std::vector<double> reach(double duration, double dt, double size = 1.0) {
    const auto n = static_cast<std::size_t>(std::lround(duration / dt));
    std::vector<double> v;
    for (std::size_t i = 0; i <= n; ++i) {
        const double s = static_cast<double>(i) / static_cast<double>(n);
        v.push_back(size * 30.0 * s * s * (1.0 - s) * (1.0 - s) / duration);
    }
    return v;
}

std::vector<double> repeated(const std::vector<double>& v, int times) {
    std::vector<double> out;
    for (int i = 0; i < times; ++i) out.insert(out.end(), v.begin(), v.end());
    return out;
}

}  // namespace

TEST(Sparc, ACleanReachIsAboutMinusOneAndAHalf) {
    EXPECT_NEAR(spectral_arc_length(reach(1.0, 0.01), 0.01), -1.41, 0.02);
    EXPECT_NEAR(spectral_arc_length(reach(2.0, 0.02), 0.02), -1.41, 0.02);
}

TEST(Sparc, DoesNotDependOnAmplitudeOrDuration) {
    const double one = spectral_arc_length(reach(1.0, 0.01), 0.01);
    EXPECT_NEAR(spectral_arc_length(reach(1.0, 0.01, 250.0), 0.01), one, 1e-9);
    EXPECT_NEAR(spectral_arc_length(reach(3.0, 0.01), 0.01), one, 0.02);
}

TEST(Sparc, MoreSubmovementsAreLessSmooth) {
    double before = 0.0;
    for (const int times : {1, 2, 4, 8}) {
        const double now = spectral_arc_length(repeated(reach(1.0, 0.01), times), 0.01);
        EXPECT_LT(now, before) << times;
        before = now;
    }
}

TEST(Sparc, ABoxOfSpeedHasTheArcLengthOfItsSinc) {
    // V(f) = |sin(pi f T) / (pi f T)|, 10 Hz cut-off and 0.05 threshold; summed here over the same frequencies.
    const double duration = 1.0, dt = 0.001;
    const std::vector<double> box(1000, 2.0);
    const auto sinc = [&](double f) {
        const double x = std::numbers::pi * f * duration;
        return x == 0.0 ? 1.0 : std::fabs(std::sin(x) / x);
    };
    const double bin = 1.0 / (16384 * dt);  // 16 times the next power of two above 1000 samples
    int last = static_cast<int>(10.0 / bin);
    while (sinc(last * bin) < 0.05) --last;
    double length = 0.0;
    for (int k = 1; k <= last; ++k) length += std::hypot(1.0 / last, sinc(k * bin) - sinc((k - 1) * bin));
    EXPECT_NEAR(spectral_arc_length(box, dt), -length, 0.01);
}

TEST(Ldlj, AMinimumJerkReachGivesItsClosedForm) {
    // v'' = 60 (1 - 6 s + 6 s^2) / T^3; integral of its square = 3600 / T^5 * 1/5 = 720 / T^5; v_peak = 1.875 / T.
    // T^3 / v_peak^2 * integral = 720 / 1.875^2 = 204.8.
    EXPECT_NEAR(log_dimensionless_jerk(reach(4.0, 0.005), 0.005), -std::log(204.8), 0.1);
}

TEST(Ldlj, HasNoDimension) {
    const double one = log_dimensionless_jerk(reach(4.0, 0.01), 0.01);
    EXPECT_NEAR(log_dimensionless_jerk(reach(4.0, 0.01, 1000.0), 0.01), one, 1e-9);
    EXPECT_NEAR(log_dimensionless_jerk(reach(8.0, 0.01), 0.01), one, 0.1);
    EXPECT_LT(log_dimensionless_jerk(repeated(reach(1.0, 0.01), 4), 0.01), one);
}

TEST(Smoothness, StandingStillIsNotJudged) {
    EXPECT_EQ(spectral_arc_length(std::vector<double>(100, 0.0), 0.01), 0.0);
    EXPECT_EQ(log_dimensionless_jerk(std::vector<double>(100, 0.0), 0.01), 0.0);
    EXPECT_EQ(spectral_arc_length({}, 0.01), 0.0);
}
