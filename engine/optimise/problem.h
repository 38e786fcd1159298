// What every optimiser of this room takes and gives back.  A caller names numbers and bounds; which library works is
// hidden.
#pragma once

#include <functional>
#include <limits>
#include <span>
#include <string>
#include <vector>

namespace cathlab {

/// A closed interval that a number may take, in the number's own unit.  lower = upper holds the number fixed.
struct Bound {
    double lower = 0.0;
    double upper = 1.0;
    std::string name;  ///< for messages; may be empty
};

/// Find the x within bounds with the least objective(x).
struct Problem {
    std::vector<Bound> bounds;
    /// Pure: the same x gives the same value, and calls may run at the same time.  NaN counts as worse than any number.
    std::function<double(std::span<const double>)> objective;
    /// Where to begin, one number a bound, clamped into it; empty = the middle (local), nowhere special (swarm).
    std::vector<double> start;
};

struct SearchProgress {
    int generation = 0;  ///< done so far (swarm); 0 for a local search
    int generations = 0;
    int evaluations = 0;
    double best_value = std::numeric_limits<double>::infinity();
    std::span<const double> best;
};

struct Result {
    std::vector<double> best;
    double value = std::numeric_limits<double>::infinity();  ///< infinity where no evaluation gave a number
    int evaluations = 0;
    int generations = 0;
    bool stopped = false;              ///< the caller's callback asked for it
    std::vector<double> best_history;  ///< least value after each generation (swarm), starting with the first positions
};

/// Throws UserError where the problem has no bounds, a bound is not finite or turned round, or start has another
/// length.
void check_problem(const Problem& problem);

}  // namespace cathlab
