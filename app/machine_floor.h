// The least time in which this machine could do a given work, measured: what a solver's speed is held against.
#pragma once

#include <cstddef>
#include <vector>

namespace cathlab {

/// Scalar operations of one kind of number.  A division or a square root counts as one product.
struct Operations {
    double products = 0.0, sums = 0.0;

    Operations& operator+=(const Operations& more) {
        products += more.products;
        sums += more.sums;
        return *this;
    }
    friend Operations operator+(Operations a, const Operations& b) { return a += b; }
    friend Operations operator*(double times, const Operations& of) { return {times * of.products, times * of.sums}; }
};

struct Arithmetic {
    Operations in_float, in_double;
};

/// ms that one core takes for so many operations when nothing stands in their way: independent, on registers, in the
/// widest vectors that the solver's kernels know here (AVX2, else SSE2), not fused.  As many products as can be are
/// paired with a sum (x <- a x + b); the rest are sums alone (a product costs the same).
double arithmetic_ms(const Arithmetic& work);

/// Two blocks of memory, one of which is copied to the other.
class CopyTimer {
public:
    /// bytes: read and written together, >= 2.
    explicit CopyTimer(std::size_t bytes);
    /// ms of one copy.
    double ms();

private:
    std::vector<unsigned char> from_, to_;
};

}  // namespace cathlab
