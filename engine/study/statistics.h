// Small-sample statistics for user studies.  A figure that cannot be computed (too few values) is NaN, never a guess.
// Values must be finite (UserError otherwise).
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace cathlab {

double mean(std::span<const double> values);
/// Standard deviation of a sample, divisor n - 1; NaN below two values.
double standard_deviation(std::span<const double> values);
/// Straight line between order statistics at place part * (n - 1) ("type 7"); part in [0, 1].
double quantile(std::span<const double> values, double part);
double median(std::span<const double> values);
/// Distance of the quartiles.
double interquartile_range(std::span<const double> values);

/// Ranks from 1, ties share their mean rank.
std::vector<double> ranks(std::span<const double> values);

struct RankTest {
    double statistic = 0.0;
    double p = 0.0;  ///< two-sided where the test has sides
    bool exact = false;
};

/// Kruskal and Wallis' H with the correction for ties, p from chi-squared with (groups - 1) degrees of freedom
/// [kruskal1952].  NaN with fewer than two groups that hold values, or where all values are equal.  Empty groups are
/// left out.
RankTest kruskal_wallis(std::span<const std::vector<double>> groups);

/// Mann and Whitney's U of the first sample (the number of pairs a > b, ties count one half) [mann1947].  p is exact
/// where there are no ties and both samples hold at most 50 values; otherwise from the normal distribution with
/// corrections for ties and continuity.  NaN where a sample is empty or all values are equal.
RankTest mann_whitney(std::span<const double> a, std::span<const double> b);

/// P(a > b) - P(a < b) over all pairs, -1 to 1 [cliff1993].
double cliffs_delta(std::span<const double> a, std::span<const double> b);

/// p values multiplied step by step after Holm [holm1979], in the order given, at most 1.  NaN stays NaN and is not
/// counted.
std::vector<double> holm(std::span<const double> p);

struct Interval {
    double low = 0.0, high = 0.0;
};

/// Percentile bootstrap of a statistic [efron1993].  The random numbers are a function of (seed, draw, place):
/// the same seed gives the same interval on any machine.  NaN below two values.
Interval bootstrap_interval(std::span<const double> values,
                            const std::function<double(std::span<const double>)>& statistic, double level = 0.95,
                            int draws = 2000, std::uint64_t seed = 1);

/// Upper tail of chi-squared, closed form for whole degrees of freedom >= 1.
double chi_squared_tail(double x, int degrees);

}  // namespace cathlab
