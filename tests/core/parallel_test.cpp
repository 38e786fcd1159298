#include "core/parallel.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <stdexcept>
#include <vector>

using namespace cathlab;

TEST(Parallel, EveryItemIsVisitedOnceByEitherKindOfRanges) {
    for (const int threads : {1, 2, 3, 4})
        for (const std::size_t count : {0U, 1U, 7U, 1000U, 10007U}) {
            std::vector<std::atomic<int>> visits(count);
            const auto visit = [&](std::size_t begin, std::size_t end) {
                EXPECT_LT(begin, end);
                for (std::size_t i = begin; i < end; ++i) ++visits[i];
            };
            Workers(threads).for_ranges(count, 64, visit);
            Workers(threads).for_even_ranges(count, 64, visit);
            for (std::size_t i = 0; i < count; ++i) EXPECT_EQ(visits[i], 2) << threads << " " << count;
        }
}

TEST(Parallel, AGatherGivesTheSameBitsOnAnyNumberOfThreads) {
    const std::size_t n = 20000;
    const auto run = [&](int threads) {
        std::vector<double> x(n, 1.0), next(n);
        const Workers workers(threads);
        for (int step = 0; step < 20; ++step) {
            workers.for_ranges(n, 32, [&](std::size_t begin, std::size_t end) {
                for (std::size_t i = begin; i < end; ++i)
                    next[i] = std::sqrt(x[i] + 0.1 * x[(i + 1) % n] + 1e-3 * static_cast<double>(i % 17));
            });
            x.swap(next);
        }
        return x;
    };
    const auto one = run(1);
    EXPECT_EQ(run(2), one);
    EXPECT_EQ(run(3), one);
}

TEST(Parallel, AnExceptionReachesTheCaller) {
    for (const int threads : {1, 3})
        EXPECT_THROW(Workers(threads).for_ranges(1000, 1,
                                                 [](std::size_t begin, std::size_t end) {
                                                     if (begin <= 500 && 500 < end)
                                                         throw std::runtime_error("item 500");
                                                 }),
                     std::runtime_error);
}

TEST(Parallel, CopiesShareAPoolAndLoopsMayNest) {
    const Workers workers(3);
    const Workers copy = workers;
    EXPECT_EQ(copy.threads(), 3);
    EXPECT_EQ(Workers(0).threads(), 1);
    std::atomic<int> sum{0};
    workers.for_ranges(10, 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
            copy.for_ranges(100, 10, [&](std::size_t b, std::size_t e) { sum += static_cast<int>(e - b); });
    });
    EXPECT_EQ(sum, 1000);
}
