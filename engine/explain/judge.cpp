#include "explain/judge.h"

#include <algorithm>
#include <cmath>

#include "core/random.h"

namespace cathlab {
namespace {

constexpr double straight_from = 3.0;  // scales
constexpr double median_to_deviation = 1.4826;

}  // namespace

double LossScale::cost(std::size_t column, double error) const {
    const double z = std::fabs(error) / of_column[column];
    return z <= straight_from ? z * z : straight_from * (2.0 * z - straight_from);
}

double LossScale::softened(std::size_t column, double error) const {
    const double root = std::sqrt(cost(column, error));
    return error < 0.0 ? -root : root;
}

LossScale loss_scale(const Columns& residual, const Split& split, std::span<const double> least) {
    LossScale out;
    for (std::size_t c = 0; c < residual.size(); ++c) {
        const std::vector<double>& column = residual[c];
        std::vector<double> sizes;
        double largest = 0.0;
        for (std::size_t i = 0; i < column.size(); ++i) {
            if (split.held_out[i] != 0 || std::isnan(column[i])) continue;
            sizes.push_back(std::fabs(column[i]));
            largest = std::max(largest, sizes.back());
        }
        double scale = least[c];
        if (!sizes.empty()) {
            const auto middle = sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2);
            std::nth_element(sizes.begin(), middle, sizes.end());
            scale = std::max(scale, median_to_deviation * *middle);
        }
        // A column that is modelled to the last digit still needs a scale.
        out.of_column.push_back(std::max({scale, 1e-6 * largest, 1e-12}));
    }
    return out;
}

double known_rows(const Columns& residual, const Split& split, std::uint8_t part) {
    double rows = 0.0;
    for (const auto& column : residual)
        for (std::size_t i = 0; i < column.size(); ++i)
            rows += split.held_out[i] == part && !std::isnan(column[i]) ? 1.0 : 0.0;
    return rows;
}

double mean_cost(const Columns& residual, const Split& split, std::uint8_t part, const LossScale& scale) {
    double sum = 0.0, rows = 0.0;
    for (std::size_t c = 0; c < residual.size(); ++c)
        for (std::size_t i = 0; i < residual[c].size(); ++i) {
            if (split.held_out[i] != part || std::isnan(residual[c][i])) continue;
            sum += scale.cost(c, residual[c][i]);
            rows += 1.0;
        }
    return rows > 0.0 ? sum / rows : 0.0;
}

std::vector<double> gains_by_chance(std::span<const Comparison> compared, const Split& split, const LossScale& scale,
                                    std::uint64_t seed) {
    constexpr std::size_t draws = 30000;
    std::vector<std::size_t> place(static_cast<std::size_t>(split.blocks), 0);  // of a block among those held out
    for (std::size_t i = 0; i < split.block.size(); ++i)
        if (split.held_out[i] != 0) place[static_cast<std::size_t>(split.block[i])] = 1;
    std::size_t blocks = 0;
    for (std::size_t& p : place) p = p != 0 ? blocks++ : 0;
    std::vector<std::vector<double>> gains(compared.size(), std::vector<double>(blocks, 0.0));
    for (std::size_t k = 0; k < compared.size(); ++k) {
        const Columns &before = *compared[k].before, &after = *compared[k].after;
        for (std::size_t c = 0; c < before.size(); ++c)
            for (std::size_t i = 0; i < before[c].size(); ++i)
                if (split.held_out[i] != 0 && !std::isnan(before[c][i]))
                    gains[k][place[static_cast<std::size_t>(split.block[i])]] +=
                        scale.cost(c, before[c][i]) - scale.cost(c, after[c][i]);
    }
    // What was seen is the first of the draws, and for each comparison all of them are put in a row.
    std::vector<std::vector<double>> sums(compared.size(), std::vector<double>(1 + draws, 0.0));
    std::vector<double> sign(blocks, 1.0);
    for (std::size_t draw = 0; draw <= draws; ++draw) {
        std::uint64_t bits = 0;
        for (std::size_t b = 0; draw > 0 && b < blocks; ++b) {
            if (b % 64 == 0) bits = random_bits(seed, RandomStream::sampling, draw - 1, b / 64);
            sign[b] = ((bits >> (b % 64)) & 1U) != 0 ? 1.0 : -1.0;
        }
        for (std::size_t k = 0; k < gains.size(); ++k)
            for (std::size_t b = 0; b < blocks; ++b) sums[k][draw] += sign[b] * gains[k][b];
    }
    constexpr double all = 1.0 + draws;
    std::vector<double> rarest(1 + draws, 1.0);  // of a draw's sums: what part of all is as large
    std::vector<double> seen;
    for (const std::vector<double>& sum : sums) {
        std::vector<double> ordered = sum;
        std::sort(ordered.begin(), ordered.end());
        for (std::size_t draw = 0; draw <= draws; ++draw) {
            const auto less = std::lower_bound(ordered.begin(), ordered.end(), sum[draw]) - ordered.begin();
            const double part = (all - static_cast<double>(less)) / all;
            rarest[draw] = std::min(rarest[draw], part);
            if (draw == 0) seen.push_back(sum[0] > 0.0 ? part : 1.0);
        }
    }
    std::sort(rarest.begin(), rarest.end());
    std::vector<double> out;
    out.reserve(seen.size());
    for (const double part : seen)
        out.push_back(static_cast<double>(std::upper_bound(rarest.begin(), rarest.end(), part) - rarest.begin()) / all);
    return out;
}

double gain_by_chance(const Columns& before, const Columns& after, const Split& split, const LossScale& scale,
                      std::uint64_t seed) {
    const Comparison one{&before, &after};
    return gains_by_chance(std::span(&one, 1), split, scale, seed)[0];
}

}  // namespace cathlab
