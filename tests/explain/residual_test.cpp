#include "explain/residual.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/random.h"

using namespace cathlab;

namespace {

std::vector<double> noise(std::size_t n, double size, std::uint64_t stream = 0) {
    std::vector<double> out;
    for (std::uint64_t i = 0; i < n; ++i) out.push_back(size * random_normal(4, RandomStream::test, stream, i));
    return out;
}

}  // namespace

TEST(Residual, RmsLeavesOutWhatIsMissingAndTheOtherPart) {
    const std::vector<double> v{3.0, std::nan(""), 4.0, 100.0};
    const std::vector<std::uint8_t> flags{0, 0, 0, 1};
    EXPECT_DOUBLE_EQ(rms(v, flags, 0), std::sqrt(12.5));
    EXPECT_DOUBLE_EQ(rms(v, flags, 1), 100.0);
}

TEST(Residual, NoiseIsSeenThroughASmoothSignalAndOutliers) {
    std::vector<double> v = noise(6000, 0.3);
    for (std::size_t i = 0; i < v.size(); ++i) {
        v[i] += 5.0 * std::sin(0.01 * static_cast<double>(i));
        if (i % 50 == 0) v[i] += 40.0;
    }
    const std::vector<Index> run(v.size(), 0);
    EXPECT_NEAR(noise_by_differences(v, run), 0.3, 0.03);
}

TEST(Residual, NeighboursOfWhiteNoiseDoNotKnowOfOneAnother) {
    const std::vector<double> white = noise(5000, 1.0);
    const std::vector<Index> run(white.size(), 0);
    EXPECT_NEAR(lag_one_autocorrelation(white, run), 0.0, 4.0 / std::sqrt(5000.0));
    std::vector<double> red{0.0};
    for (const double w : white) red.push_back(0.8 * red.back() + w);
    EXPECT_NEAR(lag_one_autocorrelation(red, std::vector<Index>(red.size(), 0)), 0.8, 0.03);
}

TEST(Residual, OutliersAreCounted) {
    std::vector<double> v = noise(2000, 1.0);
    EXPECT_LT(outlier_part(v), 0.001);
    for (std::size_t i = 0; i < v.size(); i += 40) v[i] = 30.0;
    EXPECT_NEAR(outlier_part(v), 0.025, 1e-3);
}

TEST(Spectrum, FindsTheSineInUnevenRows) {
    std::vector<double> t, v;
    const auto jitter = noise(800, 1.0, 2);
    const auto error = noise(800, 0.5, 3);
    for (std::size_t i = 0; i < 800; ++i) {
        t.push_back(0.05 * static_cast<double>(i) + 0.01 * std::tanh(jitter[i]));
        v.push_back(7.0 + 0.6 * std::sin(2.0 * std::numbers::pi * t.back() / 0.59 + 0.4) + error[i]);
    }
    const SpectrumPeak peak = highest_peak(t, v, std::vector<Index>(t.size(), 0));
    EXPECT_NEAR(peak.period_s, 0.59, 0.003);
    EXPECT_NEAR(peak.amplitude, 0.6, 0.06);
    EXPECT_LT(peak.false_alarm, 1e-9);
}

TEST(Spectrum, WhiteNoiseRaisesAlarmAsSeldomAsStated) {
    int alarms = 0;
    const int sets = 100;
    for (int s = 0; s < sets; ++s) {
        std::vector<double> t;
        const auto v = noise(200, 1.0, 100 + static_cast<std::uint64_t>(s));
        for (int i = 0; i < 200; ++i) t.push_back(0.1 * i);
        alarms += highest_peak(t, v, std::vector<Index>(t.size(), 0)).false_alarm < 0.05 ? 1 : 0;
    }
    EXPECT_LE(alarms, 14);  // 5 expected; four standard deviations
    EXPECT_EQ(
        highest_peak(std::vector<double>{0.0, 1.0}, std::vector<double>{1.0, 2.0}, std::vector<Index>{0, 0}).period_s,
        0.0);
}
