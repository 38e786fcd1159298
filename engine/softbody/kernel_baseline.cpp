#include "softbody/kernel.h"

namespace cathlab::kernel {

namespace {
#define TARGET
#define BLOCK 2
#define FLOATS 4
#include "softbody/kernel_copies.inl"
}  // namespace

const Set& baseline() {
    static const Set set{"SSE2", fit_double, fit_float, gather_goals, polar_of_double, polar_of_float};
    return set;
}

const Set& best() {
    const Set* wide = avx2();
    return wide ? *wide : baseline();
}

}  // namespace cathlab::kernel
