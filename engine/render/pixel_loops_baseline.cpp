#include "render/fast_math.h"
#include "render/pixel_loops.h"

namespace cathlab::pixel_loops {

namespace {
#define TARGET
#include "render/pixel_loops_copies.inl"
}  // namespace

const Set& baseline() {
    static const Set set{"baseline", add_depths,    pass_context,     weigh,  attenuate,
                         absorb,     quantum_noise, electronic_noise, to_log, sharpen};
    return set;
}

const Set& best() {
    const Set* wide = avx2();
    return wide ? *wide : baseline();
}

}  // namespace cathlab::pixel_loops
