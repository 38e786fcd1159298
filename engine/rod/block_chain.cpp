#include "rod/block_chain.h"

#include <algorithm>

#include "core/check.h"

namespace cathlab {
namespace {

// Two rows of a column side by side, as GCC and Clang write it for any processor; each lane is an ordinary double, so
// the bits are those of the plain loop.
using Pair = double __attribute__((vector_size(16)));

struct Column {
    Pair p[3];
};

inline Column load(const double* from) {
    Column c;
    __builtin_memcpy(&c, from, sizeof c);
    return c;
}

inline void store(double* to, const Column& c) {
    __builtin_memcpy(to, &c, sizeof c);
}

// c <- c - s v from the pair of rows `first` on
inline void subtract(Column& c, const double* v, double s, int first) {
    const Column other = load(v);
    for (int i = first; i < 3; ++i) c.p[i] -= other.p[i] * s;
}

}  // namespace

void BlockChain::factor_block(const Mat6& diagonal, const Factor* ahead, const Factor* behind, Factor& f) {
    Column unscaled[6];  // L_k d_k
#pragma GCC unroll 6
    for (int c = 0; c < 6; ++c) {
        const int top = c / 2;  // rows above the diagonal are left as they come
        Column column = load(diagonal.col(c).data());
        for (const Factor* other : {ahead, behind}) {
            if (other == nullptr) continue;
#pragma GCC unroll 6
            for (int k = 0; k < 6; ++k) subtract(column, other->z[k], other->w[k][c], top);
        }
#pragma GCC unroll 6
        for (int k = 0; k < c; ++k) {
            const double s = f.l[k][c];
            for (int i = top; i < 3; ++i) column.p[i] -= unscaled[k].p[i] * s;
        }
        const double pivot = column.p[c / 2][c % 2];
        CATHLAB_CHECK(pivot > 0.0 && pivot < 1e300, "the chain's system is not positive definite");
        f.inverse[c] = 1.0 / pivot;
        unscaled[c] = column;
        for (Pair& pair : column.p) pair *= f.inverse[c];
        store(f.l[c], column);
    }
}

void BlockChain::cross_block(const Mat6& below, Factor& f) {
#pragma GCC unroll 6
    for (int c = 0; c < 6; ++c) {
        Column column = load(below.col(c).data());
#pragma GCC unroll 6
        for (int k = 0; k < c; ++k) subtract(column, f.z[k], f.l[k][c], 0);
        store(f.z[c], column);
        for (Pair& pair : column.p) pair *= f.inverse[c];
        store(f.w[c], column);
    }
}

void BlockChain::resize(std::size_t blocks) {
    diagonal.resize(blocks);
    below.resize(blocks);
    right.resize(blocks);
    solution.resize(blocks);
    factor_.resize(blocks);
}

void BlockChain::factor(std::size_t i, const Factor* ahead, const Factor* behind) {
    Factor& f = factor_[i];
    factor_block(diagonal[i], ahead, behind, f);
    Column y = load(right[i].data());
    for (const Factor* other : {ahead, behind}) {
        if (other == nullptr) continue;
        for (int k = 0; k < 6; ++k) subtract(y, other->w[k], other->y[k], 0);
    }
    store(f.y, y);
    for (int k = 0; k < 5; ++k)
        for (int r = k + 1; r < 6; ++r) f.y[r] -= f.l[k][r] * f.y[k];
}

void BlockChain::substitute(std::size_t i, const Vec6* neighbour) {
    const Factor& f = factor_[i];
    double d[6];
    for (int c = 0; c < 6; ++c) d[c] = f.y[c] * f.inverse[c];
    if (neighbour != nullptr) {
        const Column x = load(neighbour->data());
#pragma GCC unroll 6
        for (int c = 0; c < 6; ++c) {
            const Column w = load(f.w[c]);
            const Pair sum = w.p[0] * x.p[0] + w.p[1] * x.p[1] + w.p[2] * x.p[2];
            d[c] -= sum[0] + sum[1];
        }
    }
#pragma GCC unroll 5
    for (int c = 4; c >= 0; --c)
        for (int r = c + 1; r < 6; ++r) d[c] -= f.l[c][r] * d[r];
    std::copy(d, d + 6, solution[i].data());
}

}  // namespace cathlab
