// Direct solution of a symmetric positive definite block-tridiagonal system with 6 x 6 blocks, in time linear in the
// number of blocks.  It is eliminated from both ends at once, by two threads where there are two, towards a block in
// the middle (a "twisted" factorisation), in the same order whatever the threads.  A change in some blocks leaves the
// factors between them and the ends as they are.
#pragma once

#include <algorithm>

#include "core/parallel.h"
#include "core/types.h"

namespace cathlab {

using Vec6 = Eigen::Matrix<double, 6, 1>;
using Mat6 = Eigen::Matrix<double, 6, 6>;  // column-major

/// Blocks [first, end).
struct BlockRange {
    std::size_t first = 0, end = 0;
    bool empty() const { return first >= end; }
};

class BlockChain {
public:
    std::vector<Mat6> diagonal;  ///< D_i; only the lower triangle is read
    std::vector<Mat6> below;     ///< E_i = block (i + 1, i)
    std::vector<Vec6> right;     ///< right-hand side
    std::vector<Vec6> solution;

    /// Blocks that are new are not set.
    void resize(std::size_t blocks);
    std::size_t size() const { return diagonal.size(); }

    /// Block L D L^T of the blocks that may have changed and of those between them and the middle one (earlier factors
    /// are kept from the last call), then the substitutions.  From the front, and from the back likewise with E_{i-1}^T
    /// in the place of E_i:
    ///   S_i = D_i - Z_{i-1} W_{i-1}^T = L_i d_i L_i^T,   Z_i = E_i L_i^{-T},   W_i = Z_i d_i^{-1},
    /// with L_i unit lower triangular and d_i diagonal.
    /// build(i) may set diagonal and right of a block that changed before they are read; done(i) is called with every
    /// block's solution: both by any thread, each block once.
    /// Throws std::logic_error where a pivot is not positive (the system was not positive definite, or not finite).
    template <class Build, class Done>
    void factor_and_solve(BlockRange changed, const Workers& workers, const Build& build, const Done& done) {
        const std::size_t n = size(), middle = n / 2;
        if (n == 0) return;
        const auto enter = [&](std::size_t i) {
            if (changed.first <= i && i < changed.end) build(i);
        };
        both_ways(
            workers,
            [&] {
                for (std::size_t i = changed.first; i < middle; ++i) {
                    enter(i);
                    factor(i, i > 0 ? &factor_[i - 1] : nullptr, nullptr);
                    cross_block(below[i], factor_[i]);
                }
            },
            [&] {
                for (std::size_t i = std::min(changed.end, n); i-- > middle + 1;) {
                    enter(i);
                    factor(i, nullptr, i + 1 < n ? &factor_[i + 1] : nullptr);
                    cross_block(below[i - 1].transpose(), factor_[i]);
                }
            });
        enter(middle);
        factor(middle, middle > 0 ? &factor_[middle - 1] : nullptr, middle + 1 < n ? &factor_[middle + 1] : nullptr);
        substitute(middle, nullptr);
        done(middle);
        both_ways(
            workers,
            [&] {
                for (std::size_t i = middle; i-- > 0;) {
                    substitute(i, &solution[i + 1]);
                    done(i);
                }
            },
            [&] {
                for (std::size_t i = middle + 1; i < n; ++i) {
                    substitute(i, &solution[i - 1]);
                    done(i);
                }
            });
    }

private:
    struct Factor {
        alignas(16) double l[6][6];           // L_i by columns; what stands on and above its diagonal is not used
        alignas(16) double z[6][6], w[6][6];  // Z_i, W_i by columns
        double inverse[6];                    // 1 / d_i
        alignas(16) double y[6];              // L_i^{-1} (r_i - W y of the blocks before it)
    };
    std::vector<Factor> factor_;

    template <class Front, class Back>
    static void both_ways(const Workers& workers, const Front& front, const Back& back) {
        workers.for_even_ranges(2, 1, [&](std::size_t begin, std::size_t end) {
            if (begin == 0) front();
            if (end == 2) back();
        });
    }

    /// Block i after its neighbours towards the front and towards the back, where those were eliminated before it.
    void factor(std::size_t i, const Factor* ahead, const Factor* behind);
    static void factor_block(const Mat6& diagonal, const Factor* ahead, const Factor* behind, Factor& f);
    static void cross_block(const Mat6& below, Factor& f);
    void substitute(std::size_t i, const Vec6* neighbour);
};

}  // namespace cathlab
