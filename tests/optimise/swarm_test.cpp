#include "optimise/swarm.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <limits>

#include "core/errors.h"

using namespace cathlab;

namespace {

double sphere(std::span<const double> x) {
    double sum = 0.0;
    for (std::size_t i = 0; i < x.size(); ++i) sum += std::pow(x[i] - 0.1 * static_cast<double>(i + 1), 2);
    return sum;
}

Problem sphere_problem(std::size_t n) {
    return {std::vector<Bound>(n, Bound{-2.0, 3.0, ""}), sphere, {}};
}

}  // namespace

TEST(Swarm, FindsTheMiddleOfASphere) {
    SwarmOptions options;
    options.particles = 40;
    options.generations = 80;
    const Result result = minimise_swarm(sphere_problem(4), options);
    for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(result.best[i], 0.1 * static_cast<double>(i + 1), 0.02);
    EXPECT_DOUBLE_EQ(result.value, sphere(result.best));
    EXPECT_EQ(result.evaluations, 40 * 81);
    EXPECT_EQ(result.generations, 80);
    ASSERT_EQ(result.best_history.size(), 81U);
    for (std::size_t i = 1; i < 81; ++i) EXPECT_LE(result.best_history[i], result.best_history[i - 1]);
}

TEST(Swarm, DescendsRosenbrocksValleyWithAStrongerPull) {
    const Problem problem{
        {{-2.0, 2.0, "x"}, {-2.0, 2.0, "y"}},
        [](std::span<const double> x) { return 100.0 * std::pow(x[1] - x[0] * x[0], 2) + std::pow(1.0 - x[0], 2); },
        {}};
    SwarmOptions options;
    options.omega = 0.72;
    options.eta1 = options.eta2 = 1.5;
    options.particles = 30;
    options.generations = 300;
    const Result result = minimise_swarm(problem, options);
    EXPECT_NEAR(result.best[0], 1.0, 1e-3);
    EXPECT_NEAR(result.best[1], 1.0, 1e-3);
}

TEST(Swarm, GivesTheSameBitsOnAnyNumberOfThreads) {
    SwarmOptions options;
    options.generations = 15;
    options.seed = 7;
    const Result one = minimise_swarm(sphere_problem(3), options);
    for (const int threads : {2, 3, 4}) {
        options.threads = threads;
        const Result many = minimise_swarm(sphere_problem(3), options);
        EXPECT_EQ(one.best, many.best) << threads;
        EXPECT_EQ(one.best_history, many.best_history) << threads;
    }
    options.seed = 8;
    EXPECT_NE(minimise_swarm(sphere_problem(3), options).best, one.best);
}

TEST(Swarm, StaysWithinItsBoundsAndFindsAMinimumOnThem) {
    std::atomic<int> outside{0};
    const Problem problem{{{1.0, 2.0, "a"}, {-3.0, -1.0, "b"}, {0.25, 0.25, "held"}},
                          [&](std::span<const double> x) {
                              if (x[0] < 1.0 || x[0] > 2.0 || x[1] < -3.0 || x[1] > -1.0 || x[2] != 0.25) ++outside;
                              return x[0] * x[0] + x[1] * x[1];
                          },
                          {}};
    SwarmOptions options;
    options.omega = 0.72;
    options.eta1 = options.eta2 = 1.5;
    options.generations = 60;
    const Result result = minimise_swarm(problem, options);
    EXPECT_EQ(outside, 0);
    EXPECT_NEAR(result.best[0], 1.0, 0.02);
    EXPECT_NEAR(result.best[1], -1.0, 0.02);
    EXPECT_EQ(result.best[2], 0.25);
}

TEST(Swarm, StopsWhenToldAndKeepsTheBest) {
    SwarmOptions options;
    options.particles = 10;
    int calls = 0;
    options.on_generation = [&](const SearchProgress& p) {
        ++calls;
        EXPECT_EQ(p.evaluations, 10 * calls);
        EXPECT_EQ(p.generation, calls - 1);
        return p.generation < 3;
    };
    const Result result = minimise_swarm(sphere_problem(2), options);
    EXPECT_TRUE(result.stopped);
    EXPECT_EQ(calls, 4);
    EXPECT_EQ(result.evaluations, 40);
    EXPECT_DOUBLE_EQ(result.value, sphere(result.best));
}

TEST(Swarm, BeginsWhereItIsToldAndNeverEndsWorse) {
    Problem problem = sphere_problem(2);
    problem.start = {0.1, 0.2};
    SwarmOptions options;
    options.generations = 1;
    EXPECT_LT(minimise_swarm(problem, options).value, 1e-20);
}

TEST(Swarm, TakesNanForTheWorstValue) {
    Problem problem = sphere_problem(2);
    problem.objective = [](std::span<const double> x) {
        return x[0] < 0.0 ? std::numeric_limits<double>::quiet_NaN() : sphere(x);
    };
    const Result result = minimise_swarm(problem, {});
    EXPECT_GE(result.best[0], 0.0);
    EXPECT_LT(result.value, 0.05);
    problem.objective = [](std::span<const double>) { return std::numeric_limits<double>::quiet_NaN(); };
    const Result nothing = minimise_swarm(problem, {});
    EXPECT_TRUE(nothing.best.empty());
    EXPECT_TRUE(std::isinf(nothing.value));
}

TEST(Swarm, LetsTheObjectivesErrorThrough) {
    Problem problem = sphere_problem(2);
    problem.objective = [](std::span<const double>) -> double { throw UserError("the rig broke"); };
    SwarmOptions options;
    options.threads = 3;
    EXPECT_THROW(minimise_swarm(problem, options), UserError);
}

TEST(Swarm, RefusesRangesAndOptionsThatMakeNoSense) {
    Problem problem = sphere_problem(1);
    problem.bounds[0] = {2.0, 1.0, "wall.cluster_stiffness"};
    try {
        minimise_swarm(problem, {});
        FAIL();
    } catch (const UserError& e) {
        EXPECT_NE(std::string(e.what()).find("'wall.cluster_stiffness'"), std::string::npos);
        EXPECT_NE(std::string(e.what()).find("turned round"), std::string::npos);
    }
    problem.bounds[0] = {0.0, std::numeric_limits<double>::infinity(), ""};
    EXPECT_THROW(minimise_swarm(problem, {}), UserError);
    problem.bounds.clear();
    EXPECT_THROW(minimise_swarm(problem, {}), UserError);
    SwarmOptions options;
    options.particles = 1;
    EXPECT_THROW(minimise_swarm(sphere_problem(1), options), UserError);
}
