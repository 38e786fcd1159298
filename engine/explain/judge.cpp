#include "explain/judge.h"

#include <algorithm>
#include <cmath>
#include <limits>

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
    constexpr int draws = 10000;
    const auto blocks = static_cast<std::size_t>(split.blocks);
    // Gains of the blocks, scaled so that what flips of sign give has the same spread for all.
    std::vector<std::vector<double>> gains;
    std::vector<double> observed;
    for (const auto& [before, after] : compared) {
        std::vector<double> gain(blocks, 0.0);
        for (std::size_t c = 0; c < before->size(); ++c)
            for (std::size_t i = 0; i < (*before)[c].size(); ++i)
                if (split.held_out[i] != 0 && !std::isnan((*before)[c][i]))
                    gain[static_cast<std::size_t>(split.block[i])] +=
                        scale.cost(c, (*before)[c][i]) - scale.cost(c, (*after)[c][i]);
        double square = 0.0, sum = 0.0;
        for (const double g : gain) square += g * g;
        const double size = std::sqrt(square);
        for (double& g : gain) {
            g = size > 0.0 ? g / size : 0.0;
            sum += g;
        }
        gains.push_back(std::move(gain));
        observed.push_back(sum);
    }
    std::vector<int> as_large(compared.size(), 0);
    std::vector<double> sign(blocks);
    for (int draw = 0; draw < draws; ++draw) {
        std::uint64_t bits = 0;
        for (std::size_t b = 0; b < blocks; ++b) {
            if (b % 64 == 0) bits = random_bits(seed, RandomStream::sampling, static_cast<std::uint64_t>(draw), b / 64);
            sign[b] = ((bits >> (b % 64)) & 1U) != 0 ? 1.0 : -1.0;
        }
        double largest = -std::numeric_limits<double>::infinity();
        for (const std::vector<double>& gain : gains) {
            double sum = 0.0;
            for (std::size_t b = 0; b < blocks; ++b) sum += sign[b] * gain[b];
            largest = std::max(largest, sum);
        }
        constexpr double rounding = 1e-12;
        for (std::size_t k = 0; k < observed.size(); ++k) as_large[k] += largest >= observed[k] - rounding ? 1 : 0;
    }
    std::vector<double> out;
    for (std::size_t k = 0; k < observed.size(); ++k)
        out.push_back(observed[k] > 0.0 ? (1.0 + as_large[k]) / (1.0 + draws) : 1.0);
    return out;
}

double gain_by_chance(const Columns& before, const Columns& after, const Split& split, const LossScale& scale,
                      std::uint64_t seed) {
    const Comparison one{&before, &after};
    return gains_by_chance(std::span(&one, 1), split, scale, seed)[0];
}

}  // namespace cathlab
