#include "optimise/crew.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "optimise/least_squares.h"

using namespace cathlab;

TEST(Crew, DoesEveryBodyOnceInLoopsWithinLoops) {
    for (const int threads : {-1, 0, 1, 2, 7}) {
        const Crew crew(threads);
        EXPECT_EQ(crew.threads(), std::max(1, threads));
        std::vector<std::vector<std::vector<int>>> done(9);
        crew.each(done.size(), [&](std::size_t i) {
            done[i].resize(i);
            crew.each(i, [&](std::size_t j) {
                done[i][j].resize(3);
                const Crew same = crew;
                same.each(3, [&](std::size_t k) { ++done[i][j][k]; });
            });
        });
        for (const auto& row : done)
            for (const auto& cell : row) EXPECT_EQ(cell, (std::vector<int>{1, 1, 1})) << threads;
        crew.each(0, [](std::size_t) { FAIL(); });
    }
}

TEST(Crew, PassesAnExceptionOnAndServesAgain) {
    const Crew crew(3);
    std::atomic<int> begun{0};
    EXPECT_THROW(crew.each(100,
                           [&](std::size_t k) {
                               ++begun;
                               crew.each(4, [&](std::size_t j) {
                                   if (k == 7 && j == 2) throw std::runtime_error("seven");
                               });
                           }),
                 std::runtime_error);
    EXPECT_GE(begun, 1);
    std::vector<int> done(50, 0);
    crew.each(done.size(), [&](std::size_t k) { done[k] = 1; });
    EXPECT_EQ(done, std::vector<int>(50, 1));
}

TEST(LeastSquares, FindsTheSameBitsWithAnyCrew) {
    // A sum of two decays through made rows.
    LeastSquaresProblem problem;
    problem.bounds = {{0.0, 5.0, "a"}, {0.1, 10.0, "b"}, {0.0, 5.0, "c"}, {0.1, 10.0, "d"}};
    problem.start = {1.0, 1.0, 1.0, 5.0};
    problem.residuals = 40;
    problem.residual = [](std::span<const double> x, std::span<double> out) {
        for (std::size_t i = 0; i < out.size(); ++i) {
            const double t = 0.1 * static_cast<double>(i);
            const double made = 2.0 * std::exp(-0.5 * t) + 1.5 * std::exp(-4.0 * t) + 0.01 * std::sin(17.0 * t);
            out[i] = x[0] * std::exp(-x[1] * t) + x[2] * std::exp(-x[3] * t) - made;
        }
        return true;
    };
    const Result alone = minimise_squares(problem);
    EXPECT_NEAR(alone.best[1], 0.5, 0.05);
    for (const int threads : {2, 4}) {
        LeastSquaresOptions options;
        options.crew = Crew(threads);
        const Result together = minimise_squares(problem, options);
        EXPECT_EQ(together.best, alone.best) << threads;
        EXPECT_EQ(together.value, alone.value) << threads;
        EXPECT_EQ(together.evaluations, alone.evaluations) << threads;
    }
}
