// Local search without derivatives: for smooth objectives, and to polish what a swarm has found.
#pragma once

#include "optimise/problem.h"

namespace cathlab {

enum class LocalMethod {
    bobyqa,  ///< quadratic model [powell2009]; smooth objectives; a problem of one free number uses sbplx
    sbplx    ///< simplex on subspaces [rowan1990]; objectives with kinks and small steps
};

/// Numbers are scaled by their bounds before the search: steps and tolerances are parts of a range.
struct LocalOptions {
    LocalMethod method = LocalMethod::bobyqa;
    int max_evaluations = 2000;
    double first_step = 0.1;       ///< (0, 0.5]
    double x_tolerance = 1e-8;     ///< stop when a step is smaller
    double value_tolerance = 0.0;  ///< stop when the value changes by less than this part of itself; 0 = never
    /// Called after each evaluation; false = stop and keep the best so far.
    std::function<bool(const SearchProgress&)> on_evaluation;
};

/// Throws UserError for a bad problem or options out of range.  What the objective throws passes through.
Result minimise_local(const Problem& problem, const LocalOptions& options = {});

}  // namespace cathlab
