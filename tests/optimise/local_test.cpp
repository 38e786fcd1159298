#include "optimise/local.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "core/errors.h"

using namespace cathlab;

namespace {

double rosenbrock(std::span<const double> x) {
    return 100.0 * std::pow(x[1] - x[0] * x[0], 2) + std::pow(1.0 - x[0], 2);
}

const std::vector<Bound> square{{-2.0, 2.0, "x"}, {-2.0, 2.0, "y"}};

}  // namespace

TEST(LocalSearch, BothMethodsReachTheEndOfRosenbrocksValley) {
    for (const LocalMethod method : {LocalMethod::bobyqa, LocalMethod::sbplx}) {
        LocalOptions options;
        options.method = method;
        options.max_evaluations = 20000;
        const Result result = minimise_local({square, rosenbrock, {-1.2, 1.0}}, options);
        EXPECT_NEAR(result.best[0], 1.0, 1e-4);
        EXPECT_NEAR(result.best[1], 1.0, 1e-4);
    }
}

TEST(LocalSearch, SolvesForOneNumberAndHoldsAFixedOne) {
    const Problem problem{{{0.0, 10.0, "a"}, {3.0, 3.0, "held"}},
                          [](std::span<const double> x) { return std::fabs(x[0] - 7.25) + x[1]; },
                          {}};
    const Result result = minimise_local(problem);
    EXPECT_NEAR(result.best[0], 7.25, 1e-6);
    EXPECT_EQ(result.best[1], 3.0);
    EXPECT_NEAR(result.value, 3.0, 1e-6);
}

TEST(LocalSearch, EndsOnTheBoundWhereTheMinimumIsOutside) {
    const Problem problem{
        {{1.0, 2.0, ""}, {-4.0, -1.5, ""}}, [](std::span<const double> x) { return x[0] * x[0] + x[1] * x[1]; }, {}};
    const Result result = minimise_local(problem);
    EXPECT_NEAR(result.best[0], 1.0, 1e-6);
    EXPECT_NEAR(result.best[1], -1.5, 1e-6);
}

TEST(LocalSearch, StopsWhenToldAndLetsErrorsThrough) {
    LocalOptions options;
    options.on_evaluation = [](const SearchProgress& p) { return p.evaluations < 5; };
    const Result result = minimise_local({square, rosenbrock, {}}, options);
    EXPECT_TRUE(result.stopped);
    EXPECT_EQ(result.evaluations, 5);
    const auto broken = [](std::span<const double>) -> double { throw std::runtime_error("broken"); };
    EXPECT_THROW(minimise_local({square, broken, {}}), std::runtime_error);
}

TEST(LocalSearch, WalksAwayFromNan) {
    const auto half = [](std::span<const double> x) {
        return x[0] > 1.2 ? std::numeric_limits<double>::quiet_NaN() : std::pow(x[0] - 1.0, 2) + x[1] * x[1];
    };
    LocalOptions options;
    options.method = LocalMethod::sbplx;
    const Result result = minimise_local({square, half, {-1.0, 1.0}}, options);
    EXPECT_NEAR(result.best[0], 1.0, 1e-3);
    EXPECT_NEAR(result.best[1], 0.0, 1e-3);
}

TEST(LocalSearch, RefusesAStartOfAnotherLength) {
    EXPECT_THROW(minimise_local({square, rosenbrock, {1.0}}), UserError);
}
