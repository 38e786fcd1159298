// Direct solution of a symmetric positive definite block-tridiagonal system with 6 x 6 blocks, in time linear in the
// number of blocks.  A change in block i leaves the factors of the blocks before it as they are.
#pragma once

#include "core/types.h"

namespace cathlab {

using Vec6 = Eigen::Matrix<double, 6, 1>;
using Mat6 = Eigen::Matrix<double, 6, 6>;  // column-major

class BlockChain {
public:
    std::vector<Mat6> diagonal;  ///< D_i; only the lower triangle is read
    std::vector<Mat6> below;     ///< E_i = block (i + 1, i)
    std::vector<Vec6> right;     ///< right-hand side
    std::vector<Vec6> solution;

    /// All blocks zero.
    void resize(std::size_t blocks);
    std::size_t size() const { return diagonal.size(); }

    /// Block L D L^T from block `first` on (earlier factors are kept from the last call), then both substitutions:
    ///   S_i = D_i - Z_{i-1} W_{i-1}^T = L_i d_i L_i^T,   Z_i = E_i L_i^{-T},   W_i = Z_i d_i^{-1},
    /// with L_i unit lower triangular and d_i diagonal.
    /// Throws std::logic_error where a pivot is not positive (the system was not positive definite, or not finite).
    void factor_and_solve(std::size_t first);

private:
    struct Factor {
        alignas(16) double l[6][6];           // L_i by columns; what stands on and above its diagonal is not used
        alignas(16) double z[6][6], w[6][6];  // Z_i, W_i by columns
        double inverse[6];                    // 1 / d_i
        alignas(16) double y[6];              // L_i^{-1} (r_i - W_{i-1} y_{i-1})
    };
    std::vector<Factor> factor_;

    static void factor_block(const Mat6& diagonal, const Factor* before, Factor& f);
    static void cross_block(const Mat6& below, Factor& f);
};

}  // namespace cathlab
