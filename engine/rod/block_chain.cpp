#include "rod/block_chain.h"

#include <cmath>

#include "core/check.h"

namespace cathlab {
namespace {

// The loops run over all six rows of a column, also above the diagonal: two by two they fill the processor's lanes.
// L (column-major, inverse diagonal) of S = D - X X^T, or of D where cross is null.
void factor_block(const double* d, const double* cross, double* l) {
    for (int c = 0; c < 6; ++c) {
        double column[6];
        for (int r = 0; r < 6; ++r) column[r] = d[6 * c + r];
        if (cross != nullptr) {
            for (int k = 0; k < 6; ++k) {
                const double s = cross[6 * k + c];
                for (int r = 0; r < 6; ++r) column[r] -= cross[6 * k + r] * s;
            }
        }
        for (int k = 0; k < c; ++k) {
            const double s = l[6 * k + c];
            for (int r = 0; r < 6; ++r) column[r] -= l[6 * k + r] * s;
        }
        CATHLAB_CHECK(column[c] > 0.0 && std::isfinite(column[c]), "the chain's system is not positive definite");
        const double inverse = 1.0 / std::sqrt(column[c]);
        for (int r = 0; r < 6; ++r) l[6 * c + r] = column[r] * inverse;
        l[6 * c + c] = inverse;
    }
}

// X = E L^{-T}, column by column: X L^T = E.
void cross_block(const double* e, const double* l, double* x) {
    for (int c = 0; c < 6; ++c) {
        double column[6];
        for (int r = 0; r < 6; ++r) column[r] = e[6 * c + r];
        for (int k = 0; k < c; ++k) {
            const double s = l[6 * k + c];
            for (int r = 0; r < 6; ++r) column[r] -= x[6 * k + r] * s;
        }
        const double inverse = l[6 * c + c];
        for (int r = 0; r < 6; ++r) x[6 * c + r] = column[r] * inverse;
    }
}

void forward(const double* l, double* y) {  // y <- L^{-1} y
    for (int c = 0; c < 6; ++c) {
        y[c] *= l[6 * c + c];
        for (int r = c + 1; r < 6; ++r) y[r] -= l[6 * c + r] * y[c];
    }
}

void backward(const double* l, double* y) {  // y <- L^{-T} y
    for (int c = 5; c >= 0; --c) {
        for (int r = c + 1; r < 6; ++r) y[c] -= l[6 * c + r] * y[r];
        y[c] *= l[6 * c + c];
    }
}

}  // namespace

void BlockChain::resize(std::size_t blocks) {
    diagonal.assign(blocks, Mat6::Zero());
    below.assign(blocks, Mat6::Zero());
    right.assign(blocks, Vec6::Zero());
    solution.resize(blocks);
    factor_.resize(blocks);
    cross_.resize(blocks);
    half_.resize(blocks);
}

void BlockChain::factor_and_solve(std::size_t first) {
    const std::size_t n = size();
    for (std::size_t i = first; i < n; ++i) {
        factor_block(diagonal[i].data(), i > 0 ? cross_[i - 1].data() : nullptr, factor_[i].data());
        if (i + 1 < n) cross_block(below[i].data(), factor_[i].data(), cross_[i].data());
        half_[i] = right[i];
        if (i > 0) half_[i].noalias() -= cross_[i - 1].lazyProduct(half_[i - 1]);
        forward(factor_[i].data(), half_[i].data());
    }
    for (std::size_t i = n; i-- > 0;) {
        solution[i] = half_[i];
        if (i + 1 < n) solution[i].noalias() -= cross_[i].transpose().lazyProduct(solution[i + 1]);
        backward(factor_[i].data(), solution[i].data());
    }
}

}  // namespace cathlab
