// One solve of 300 free links on one thread; the target is 0.25 ms.  The figure is printed; the test fails only where
// it is so far off that the solve can no longer be linear.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cstdio>

#include "rod_fixture.h"

namespace cathlab {
namespace {

double solve_ms(double insertion, std::size_t row_every) {
    Rod rod(test::amplatz(3.0), {}, insertion);
    std::vector<ChainRow> rows;
    if (row_every > 0) {
        for (std::size_t i = 0; i < rod.free_link_count(); i += row_every) {
            ChainRow row;
            row.link = static_cast<Index>(i);
            row.normal = Vec3::UnitX();
            row.compliance = 1e-2;
            row.gap = i % (2 * row_every) == 0 ? -0.01 : 0.02;
            row.friction = 0.1;
            rows.push_back(row);
        }
    }
    const double h = 0.004;
    std::vector<double> times;
    for (int i = 0; i < 60; ++i) {
        rod.command(0.0, 0.01);
        rod.predict(h);
        const auto begin = std::chrono::steady_clock::now();
        rod.solve(h, rows);
        const auto end = std::chrono::steady_clock::now();
        rod.finish(h);
        times.push_back(std::chrono::duration<double, std::milli>(end - begin).count());
    }
    std::sort(times.begin(), times.end());
    return times[times.size() / 2];
}

TEST(Speed, ThreeHundredLinksSolveInAFractionOfAMillisecond) {
    const double free = solve_ms(899.0, 0), half = solve_ms(449.0, 0), touching = solve_ms(899.0, 1);
    std::printf("300 links %.3f ms, 150 links %.3f ms, 300 links with 300 rows %.3f ms\n", free, half, touching);
    EXPECT_LT(free, 10.0);
}

}  // namespace
}  // namespace cathlab
