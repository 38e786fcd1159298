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

    /// Block Cholesky from block `first` on (earlier factors are kept from the last call), then both substitutions:
    ///   S_i = D_i - X_{i-1} X_{i-1}^T = L_i L_i^T,   X_i = E_i L_i^{-T}.
    /// Throws std::logic_error where a pivot is not positive (the system was not positive definite, or not finite).
    void factor_and_solve(std::size_t first);

private:
    std::vector<Mat6> factor_;  // L_i, with 1 / L_kk on the diagonal
    std::vector<Mat6> cross_;   // X_i
    std::vector<Vec6> half_;    // L_i^{-1} (r_i - X_{i-1} y_{i-1})
};

}  // namespace cathlab
