#include "optimise/least_squares.h"

#include <gtest/gtest.h>

#include <cmath>

using namespace cathlab;

namespace {

/// A narrow valley x + y (1 + y / 20) = 3 that runs out of the box at x = 0.
LeastSquaresProblem slanting_valley(double narrow) {
    LeastSquaresProblem problem;
    problem.bounds = {{0.0, 10.0, "x"}, {-10.0, 10.0, "y"}, {-10.0, 10.0, "z"}};
    problem.start = {9.0, -9.0, -9.0};
    problem.residuals = 4;
    problem.residual = [narrow](std::span<const double> x, std::span<double> out) {
        out[0] = narrow * (x[0] + x[1] * (1.0 + x[1] / 20.0) - 3.0);
        out[1] = x[0] + 6.0;
        out[2] = narrow * (x[2] - std::sin(x[1]) - 0.3 * x[0]);
        out[3] = 0.1 * (x[2] - 1.0);
        return true;
    };
    return problem;
}

}  // namespace

TEST(LeastSquares, GoesOnAlongABoundThatAValleyRunsThrough) {
    for (const double narrow : {1.0, 30.0, 100.0}) {
        LeastSquaresOptions options;
        options.value_tolerance = 1e-9;
        const Result found = minimise_squares(slanting_valley(narrow), options);
        EXPECT_EQ(found.best[0], 0.0) << narrow;
        // What is least on the bound itself, by the same search without it.
        LeastSquaresProblem on_it = slanting_valley(narrow);
        on_it.bounds[0].upper = 0.0;
        on_it.start = {0.0, 2.5, 0.5};
        EXPECT_NEAR(found.value, minimise_squares(on_it, options).value, 1e-6 * found.value) << narrow;
    }
}

TEST(LeastSquares, LeavesABoundOnWhichItBegins) {
    LeastSquaresProblem problem;
    problem.bounds = {{0.0, 1.0, "x"}, {0.0, 1.0, "y"}};
    problem.start = {0.0, 1.0};
    problem.residuals = 2;
    problem.residual = [](std::span<const double> x, std::span<double> out) {
        out[0] = 10.0 * (x[0] - 0.3) + x[1];
        out[1] = x[1] - 0.4;
        return true;
    };
    const Result found = minimise_squares(problem);
    EXPECT_NEAR(found.best[0], 0.26, 1e-6);
    EXPECT_NEAR(found.best[1], 0.4, 1e-6);
}
