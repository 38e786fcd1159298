#include "study/statistics.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "core/check.h"
#include "core/errors.h"
#include "core/random.h"

namespace cathlab {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

void check_finite(std::span<const double> values) {
    for (const double v : values)
        if (!std::isfinite(v)) throw UserError("a value that is not finite cannot be ranked or averaged");
}

std::vector<double> sorted(std::span<const double> values) {
    check_finite(values);
    std::vector<double> out(values.begin(), values.end());
    std::sort(out.begin(), out.end());
    return out;
}

/// Sum over groups of equal values of t^3 - t.
double tie_sum(std::span<const double> values) {
    const std::vector<double> s = sorted(values);
    double sum = 0.0;
    for (std::size_t i = 0; i < s.size();) {
        std::size_t j = i;
        while (j < s.size() && s[j] == s[i]) ++j;
        const auto t = static_cast<double>(j - i);
        sum += t * t * t - t;
        i = j;
    }
    return sum;
}

/// P(U >= u) without ties: counts of the ways in which n1 of n1 + n2 ranks give each U, by the recursion over ranks.
double exact_upper_tail(std::size_t n1, std::size_t n2, double u) {
    const std::size_t top = n1 * n2;
    // ways[i][s]: subsets of i ranks, whose U (rank sum less i (i + 1) / 2) is s; one rank is offered after another.
    std::vector<std::vector<double>> ways(n1 + 1, std::vector<double>(top + 1, 0.0));
    ways[0][0] = 1.0;
    for (std::size_t rank = 1; rank <= n1 + n2; ++rank)
        for (std::size_t i = std::min(rank, n1); i >= 1; --i) {
            const std::size_t gain = rank - i;  // smaller ranks that belong to the other sample
            if (gain > n2) continue;
            for (std::size_t s = gain; s <= top; ++s) ways[i][s] += ways[i - 1][s - gain];
        }
    const double all = std::accumulate(ways[n1].begin(), ways[n1].end(), 0.0);
    double tail = 0.0;
    for (std::size_t s = top + 1; s-- > 0 && static_cast<double>(s) >= u;) tail += ways[n1][s];
    return tail / all;
}

}  // namespace

double mean(std::span<const double> values) {
    check_finite(values);
    if (values.empty()) return nan;
    return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

double standard_deviation(std::span<const double> values) {
    if (values.size() < 2) return nan;
    const double middle = mean(values);
    double sum = 0.0;
    for (const double v : values) sum += (v - middle) * (v - middle);
    return std::sqrt(sum / static_cast<double>(values.size() - 1));
}

double quantile(std::span<const double> values, double part) {
    CATHLAB_CHECK(part >= 0.0 && part <= 1.0, "a quantile is a part of one");
    if (values.empty()) return nan;
    const std::vector<double> s = sorted(values);
    const double place = part * static_cast<double>(s.size() - 1);
    const auto low = static_cast<std::size_t>(place);
    const std::size_t high = std::min(low + 1, s.size() - 1);
    return s[low] + (place - static_cast<double>(low)) * (s[high] - s[low]);
}

double median(std::span<const double> values) {
    return quantile(values, 0.5);
}

double interquartile_range(std::span<const double> values) {
    return quantile(values, 0.75) - quantile(values, 0.25);
}

std::vector<double> ranks(std::span<const double> values) {
    check_finite(values);
    std::vector<std::size_t> order(values.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return values[a] < values[b]; });
    std::vector<double> out(values.size());
    for (std::size_t i = 0; i < order.size();) {
        std::size_t j = i;
        while (j < order.size() && values[order[j]] == values[order[i]]) ++j;
        for (std::size_t k = i; k < j; ++k) out[order[k]] = 0.5 * static_cast<double>(i + 1 + j);
        i = j;
    }
    return out;
}

RankTest kruskal_wallis(std::span<const std::vector<double>> groups) {
    std::vector<double> all;
    int used = 0;
    for (const auto& group : groups) {
        all.insert(all.end(), group.begin(), group.end());
        used += group.empty() ? 0 : 1;
    }
    if (used < 2) return {nan, nan, false};
    const std::vector<double> rank = ranks(all);
    const auto n = static_cast<double>(all.size());
    const double correction = 1.0 - tie_sum(all) / (n * n * n - n);
    if (correction <= 0.0) return {nan, nan, false};
    double sum = 0.0;
    std::size_t place = 0;
    for (const auto& group : groups) {
        if (group.empty()) continue;
        double rank_sum = 0.0;
        for (std::size_t i = 0; i < group.size(); ++i) rank_sum += rank[place++];
        sum += rank_sum * rank_sum / static_cast<double>(group.size());
    }
    const double h = (12.0 / (n * (n + 1.0)) * sum - 3.0 * (n + 1.0)) / correction;
    return {h, chi_squared_tail(std::max(h, 0.0), used - 1), false};
}

RankTest mann_whitney(std::span<const double> a, std::span<const double> b) {
    if (a.empty() || b.empty()) return {nan, nan, false};
    std::vector<double> all(a.begin(), a.end());
    all.insert(all.end(), b.begin(), b.end());
    const std::vector<double> rank = ranks(all);
    const auto n1 = static_cast<double>(a.size());
    const auto n2 = static_cast<double>(b.size());
    const double rank_sum = std::accumulate(rank.begin(), rank.begin() + static_cast<std::ptrdiff_t>(a.size()), 0.0);
    const double u = rank_sum - n1 * (n1 + 1.0) / 2.0;
    const double far = std::max(u, n1 * n2 - u);
    const double ties = tie_sum(all);
    constexpr std::size_t largest_exact = 50;
    if (ties == 0.0 && std::max(a.size(), b.size()) <= largest_exact)
        return {u, std::min(1.0, 2.0 * exact_upper_tail(a.size(), b.size(), far)), true};
    const double n = n1 + n2;
    const double variance = n1 * n2 / 12.0 * ((n + 1.0) - ties / (n * (n - 1.0)));
    if (variance <= 0.0) return {u, nan, false};
    const double z = (far - n1 * n2 / 2.0 - 0.5) / std::sqrt(variance);
    return {u, std::min(1.0, std::erfc(z / std::numbers::sqrt2)), false};
}

double cliffs_delta(std::span<const double> a, std::span<const double> b) {
    if (a.empty() || b.empty()) return nan;
    check_finite(a);
    check_finite(b);
    double sum = 0.0;
    for (const double x : a)
        for (const double y : b) sum += x > y ? 1.0 : (x < y ? -1.0 : 0.0);
    return sum / (static_cast<double>(a.size()) * static_cast<double>(b.size()));
}

std::vector<double> holm(std::span<const double> p) {
    std::vector<std::size_t> order;
    for (std::size_t i = 0; i < p.size(); ++i)
        if (!std::isnan(p[i])) order.push_back(i);
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return p[a] < p[b]; });
    std::vector<double> out(p.size(), nan);
    double largest = 0.0;
    for (std::size_t k = 0; k < order.size(); ++k) {
        largest = std::max(largest, std::min(1.0, p[order[k]] * static_cast<double>(order.size() - k)));
        out[order[k]] = largest;
    }
    return out;
}

Interval bootstrap_interval(std::span<const double> values,
                            const std::function<double(std::span<const double>)>& statistic, double level, int draws,
                            std::uint64_t seed) {
    CATHLAB_CHECK(level > 0.0 && level < 1.0 && draws >= 1, "level in (0, 1) and at least one draw");
    check_finite(values);
    if (values.size() < 2) return {nan, nan};
    std::vector<double> sample(values.size());
    std::vector<double> results;
    for (int draw = 0; draw < draws; ++draw) {
        for (std::size_t i = 0; i < sample.size(); ++i) {
            const double u = random_uniform(seed, RandomStream::sampling, static_cast<std::uint64_t>(draw), i);
            sample[i] = values[static_cast<std::size_t>(u * static_cast<double>(values.size()))];
        }
        results.push_back(statistic(sample));
    }
    return {quantile(results, 0.5 * (1.0 - level)), quantile(results, 0.5 * (1.0 + level))};
}

double chi_squared_tail(double x, int degrees) {
    CATHLAB_CHECK(degrees >= 1 && x >= 0.0, "degrees >= 1, x >= 0");
    // Q(a + 1, h) = Q(a, h) + h^a e^-h / gamma(a + 1), from Q(1, h) = e^-h or Q(1/2, h) = erfc(sqrt h).
    const double h = 0.5 * x;
    const bool even = degrees % 2 == 0;
    double a = even ? 1.0 : 0.5;
    double tail = even ? std::exp(-h) : std::erfc(std::sqrt(h));
    double term = even ? h * std::exp(-h) : std::sqrt(h) * std::exp(-h) * 2.0 * std::numbers::inv_sqrtpi;
    for (int left = degrees - 2; left > 0; left -= 2) {
        tail += term;
        a += 1.0;
        term *= h / a;
    }
    return std::min(1.0, tail);
}

}  // namespace cathlab
