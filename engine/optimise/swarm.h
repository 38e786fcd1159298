// Particle swarm: for objectives that are noisy, stepped or have many valleys.
#pragma once

#include <cstdint>

#include "optimise/problem.h"

namespace cathlab {

/// v <- omega v + eta1 r1 (own best - x) + eta2 r2 (swarm's best - x);  x <- x + v, r1 and r2 uniform in [0, 1] a
/// coordinate. The three factors are Li et al.'s [li2025].
struct SwarmOptions {
    int particles = 24;      ///< at least 2
    int generations = 40;    ///< at least 1
    double omega = 0.3;      ///< inertia, 0 to 1
    double eta1 = 0.5;       ///< pull of the particle's own best, 0 to 4
    double eta2 = 0.3;       ///< pull of the swarm's best, 0 to 4
    double max_speed = 0.5;  ///< a generation's largest move, as a part of the range, (0, 1]
    std::uint64_t seed = 1;
    int threads = 1;  ///< evaluations at the same time; does not change the result by a bit
    /// Called after each generation; false = stop and keep the best so far.
    std::function<bool(const SearchProgress&)> on_generation;
};

/// Throws UserError for a bad problem or options out of range.  What the objective throws passes through.
Result minimise_swarm(const Problem& problem, const SwarmOptions& options = {});

}  // namespace cathlab
