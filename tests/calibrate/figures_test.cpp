#include "calibrate/figures.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

using namespace cathlab;

TEST(Figures, AreThoseCountedByHand) {
    const std::array<double, 5> e{1.0, -2.0, 3.0, -4.0, 5.0};
    const Figures f = figures_of(e);
    EXPECT_NEAR(f.rmse, std::sqrt(11.0), 1e-12);
    EXPECT_NEAR(f.mean, 0.6, 1e-12);
    EXPECT_NEAR(f.sd, std::sqrt((0.16 + 6.76 + 5.76 + 21.16 + 19.36) / 4.0), 1e-12);
    EXPECT_NEAR(f.mean_absolute, 3.0, 1e-12);
    EXPECT_NEAR(f.sd_absolute, std::sqrt(2.5), 1e-12);
    EXPECT_NEAR(f.median, 3.0, 1e-12);
    EXPECT_NEAR(f.p90, 4.6, 1e-12);
    EXPECT_NEAR(f.maximum, 5.0, 1e-12);
}

TEST(Figures, OfOneDifferenceHaveNoSpread) {
    const Figures f = figures_of(std::array{-2.0});
    EXPECT_EQ(f.rmse, 2.0);
    EXPECT_EQ(f.sd, 0.0);
    EXPECT_EQ(f.p90, 2.0);
}

TEST(Figures, OfNothingOrOfWhatIsNotFiniteAreNone) {
    EXPECT_TRUE(std::isnan(figures_of(std::span<const double>{}).rmse));
    EXPECT_TRUE(std::isnan(figures_of(std::array{1.0, std::nan("")}).maximum));
}
