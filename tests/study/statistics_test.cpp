// Numbers marked "scipy" were computed by scipy 1.10.1; the rest are closed forms.
#include "study/statistics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/errors.h"
#include "core/random.h"

using namespace cathlab;

namespace {
const std::vector<double> a{2.1, 3.4, 1.9, 5.6, 4.4, 2.8, 3.3, 6.1, 2.2, 4.9};
const std::vector<double> b{7.2, 5.5, 6.6, 4.1, 8.3, 5.9, 7.7, 6.0, 5.1, 9.4};
const std::vector<double> c{3.0, 4.0, 4.2, 3.6, 5.0, 4.8, 2.5, 3.9, 4.6, 5.2};
const std::vector<double> t1{1, 2, 2, 3, 3, 3, 4, 5};
const std::vector<double> t2{2, 3, 4, 4, 5, 5, 6, 6, 7};
}  // namespace

TEST(Statistics, MeanSpreadAndQuartilesAgreeWithScipy) {
    EXPECT_NEAR(mean(a), 3.67, 1e-12);
    EXPECT_NEAR(standard_deviation(a), 1.5055822055861903, 1e-12);
    EXPECT_NEAR(quantile(a, 0.25), 2.35, 1e-12);
    EXPECT_NEAR(median(a), 3.35, 1e-12);
    EXPECT_NEAR(interquartile_range(a), 4.775 - 2.35, 1e-12);
    EXPECT_EQ(median(std::vector<double>{3.0}), 3.0);
}

TEST(Statistics, KruskalWallisAgreesWithScipy) {
    const RankTest three = kruskal_wallis(std::vector<std::vector<double>>{a, b, c});
    EXPECT_NEAR(three.statistic, 13.865806451612912, 1e-9);
    EXPECT_NEAR(three.p, 0.0009751656286975149, 1e-12);
    const RankTest two = kruskal_wallis(std::vector<std::vector<double>>{a, {}, b});
    EXPECT_NEAR(two.statistic, 9.142857142857139, 1e-9);
    EXPECT_NEAR(two.p, 0.00249690891514156, 1e-12);
    const RankTest ties = kruskal_wallis(std::vector<std::vector<double>>{t1, t2, {1, 1, 2, 9, 9}});
    EXPECT_NEAR(ties.statistic, 3.4047087890999785, 1e-9);
    EXPECT_NEAR(ties.p, 0.18225392088545694, 1e-12);
}

TEST(Statistics, MannWhitneyIsExactForSmallSamplesWithoutTies) {
    const RankTest small = mann_whitney(std::vector<double>{1, 2, 3}, std::vector<double>{4, 5, 6});
    EXPECT_EQ(small.statistic, 0.0);
    EXPECT_NEAR(small.p, 2.0 / 20.0, 1e-15);  // 2 of the 6-choose-3 orders are as far out
    EXPECT_TRUE(small.exact);
    const RankTest ten = mann_whitney(a, b);
    EXPECT_EQ(ten.statistic, 10.0);
    EXPECT_NEAR(ten.p, 0.0015046872632011952, 1e-15);  // scipy
    EXPECT_EQ(mann_whitney(b, a).statistic, 90.0);
    EXPECT_DOUBLE_EQ(mann_whitney(b, a).p, ten.p);
}

TEST(Statistics, MannWhitneyWithTiesAgreesWithScipy) {
    const RankTest tied = mann_whitney(t1, t2);
    EXPECT_FALSE(tied.exact);
    EXPECT_EQ(tied.statistic, 13.5);
    EXPECT_NEAR(tied.p, 0.03175895714806371, 1e-12);
}

TEST(Statistics, AnExactTestOfEqualSamplesIsCertainOfNothing) {
    EXPECT_EQ(mann_whitney(std::vector<double>{1, 4}, std::vector<double>{2, 3}).p, 1.0);
}

TEST(Statistics, CliffsDeltaCountsPairs) {
    EXPECT_EQ(cliffs_delta(std::vector<double>{1, 2, 3}, std::vector<double>{4, 5}), -1.0);
    EXPECT_EQ(cliffs_delta(t1, t1), 0.0);
    // Without ties delta = 2 U / (n1 n2) - 1.
    EXPECT_NEAR(cliffs_delta(a, b), 2.0 * mann_whitney(a, b).statistic / 100.0 - 1.0, 1e-15);
}

TEST(Statistics, HolmStepsDownAndNeverGoesBack) {
    const std::vector<double> out = holm(std::vector<double>{0.04, 0.01, 0.03, std::nan(""), 0.9});
    EXPECT_NEAR(out[1], 0.04, 1e-15);
    EXPECT_NEAR(out[2], 0.09, 1e-15);
    EXPECT_NEAR(out[0], 0.09, 1e-15);  // 0.08 would be less than its smaller neighbour's
    EXPECT_NEAR(out[4], 0.9, 1e-15);
    EXPECT_TRUE(std::isnan(out[3]));
}

TEST(Statistics, TheTailOfChiSquaredAgreesWithScipy) {
    EXPECT_NEAR(chi_squared_tail(3.2, 1), 0.07363827012030258, 1e-14);
    EXPECT_NEAR(chi_squared_tail(3.2, 2), 0.2018965179946554, 1e-14);
    EXPECT_NEAR(chi_squared_tail(3.2, 3), 0.36180502749753174, 1e-14);
    EXPECT_NEAR(chi_squared_tail(20.0, 4), 0.0004993992273873336, 1e-16);
    EXPECT_NEAR(chi_squared_tail(0.5, 7), 0.9994464813904249, 1e-14);
    EXPECT_NEAR(chi_squared_tail(100.0, 5) / 5.285148360943219e-20, 1.0, 1e-10);
    EXPECT_EQ(chi_squared_tail(0.0, 3), 1.0);
}

TEST(Statistics, TheBootstrapOfAMeanHasTheWidthOfItsStandardError) {
    std::vector<double> values;
    for (std::uint64_t i = 0; i < 400; ++i) values.push_back(random_normal(3, RandomStream::test, 0, i));
    const Interval interval = bootstrap_interval(values, mean, 0.95, 4000, 11);
    const double expected = 2.0 * 1.959964 * standard_deviation(values) / 20.0;
    EXPECT_NEAR(interval.high - interval.low, expected, 0.06 * expected);
    EXPECT_LT(interval.low, mean(values));
    EXPECT_GT(interval.high, mean(values));
    const Interval again = bootstrap_interval(values, mean, 0.95, 4000, 11);
    EXPECT_EQ(again.low, interval.low);
    EXPECT_NE(bootstrap_interval(values, mean, 0.95, 4000, 12).low, interval.low);
}

TEST(Statistics, SayNanWhereThereIsTooLittleToSayAnything) {
    const std::vector<double> none;
    const std::vector<double> same{2.0, 2.0};
    EXPECT_TRUE(std::isnan(mean(none)));
    EXPECT_TRUE(std::isnan(median(none)));
    EXPECT_TRUE(std::isnan(standard_deviation(std::vector<double>{1.0})));
    EXPECT_TRUE(std::isnan(mann_whitney(a, none).p));
    EXPECT_TRUE(std::isnan(mann_whitney(same, same).p));
    EXPECT_TRUE(std::isnan(cliffs_delta(none, a)));
    EXPECT_TRUE(std::isnan(kruskal_wallis(std::vector<std::vector<double>>{a}).p));
    EXPECT_TRUE(std::isnan(kruskal_wallis(std::vector<std::vector<double>>{same, same}).p));
    EXPECT_TRUE(std::isnan(bootstrap_interval(std::vector<double>{1.0}, mean).low));
    EXPECT_THROW(mean(std::vector<double>{1.0, std::numeric_limits<double>::infinity()}), UserError);
}
