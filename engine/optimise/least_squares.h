// Nonlinear least squares: for models whose errors are known row by row.
#pragma once

#include "optimise/crew.h"
#include "optimise/problem.h"

namespace cathlab {

/// Find the x within bounds with the least sum of squares of residual(x).
struct LeastSquaresProblem {
    std::vector<Bound> bounds;  ///< lower = upper holds a number fixed
    /// Writes the residuals, always the same number of them; pure, and asked by several threads at once where the
    /// options name a crew of them.  False = no model at this x (worse than any).
    std::function<bool(std::span<const double> x, std::span<double> residual)> residual;
    std::size_t residuals = 0;
    std::vector<double> start;  ///< one number a bound, clamped into it; empty = the middle
};

struct LeastSquaresOptions {
    int max_iterations = 50;
    double value_tolerance = 1e-6;  ///< stop when the sum changes by less than this part of itself
    double step = 1e-4;             ///< of the derivatives by differences, in parts of a range
    Crew crew;                      ///< asks for the derivatives by all numbers at once
};

/// Trust region with box constraints (Ceres, Levenberg and Marquardt [more1978]); derivatives by forward differences of
/// numbers scaled by their ranges.  Result::value is half the sum of squares.  The same start gives the same bits, with
/// any crew. Throws UserError for a bad problem.
Result minimise_squares(const LeastSquaresProblem& problem, const LeastSquaresOptions& options = {});

}  // namespace cathlab
