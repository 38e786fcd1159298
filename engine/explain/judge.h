// Whether one model is better than another on rows that neither was fitted to, by more than chance allows.
#pragma once

#include <cstdint>
#include <span>

#include "explain/rig.h"

namespace cathlab {

/// What an error costs: Huber's loss [huber1964] of the error over the column's scale, quadratic up to three scales and
/// straight beyond, so that a few wild rows do not decide.
struct LossScale {
    std::vector<double> of_column;  ///< > 0
    double cost(std::size_t column, double error) const;
    /// An error whose square costs the same.
    double softened(std::size_t column, double error) const;
};

/// Robust scales (1.4826 median absolute value) of the rows that the fit sees, at least what is known of each column's
/// noise and of how far the base model is itself off there: what nobody can know does not decide.
LossScale loss_scale(const Columns& residual, const Split& split, std::span<const double> least);

/// Known rows of a part, all columns together.
double known_rows(const Columns& residual, const Split& split, std::uint8_t part);

/// Mean cost of a known row of a part.
double mean_cost(const Columns& residual, const Split& split, std::uint8_t part, const LossScale& scale);

/// What a model left, and what another one leaves.
struct Comparison {
    const Columns* before = nullptr;
    const Columns* after = nullptr;
};

/// For each comparison: how often chance alone would give one of them a gain on the held-out blocks that is as rare for
/// it as this one's is.  The blocks' signs are flipped at random, whole blocks at a time, since neighbours know of one
/// another [edgington1995], and for all comparisons alike, so that those which gain in the same blocks count as few
/// [westfall1993].  1 / 30001 at least.
std::vector<double> gains_by_chance(std::span<const Comparison> compared, const Split& split, const LossScale& scale,
                                    std::uint64_t seed);

/// The same of one alone.
double gain_by_chance(const Columns& before, const Columns& after, const Split& split, const LossScale& scale,
                      std::uint64_t seed);

}  // namespace cathlab
