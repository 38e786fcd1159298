#include "render/fast_math.h"
#include "render/pixel_loops.h"

namespace cathlab::pixel_loops {

#if defined(__x86_64__)

namespace {
#define TARGET __attribute__((target("avx2")))
#include "render/pixel_loops_copies.inl"
}  // namespace

const Set* avx2() {
    static const Set set{"AVX2", add_depths,    pass_context,     weigh,  attenuate,
                         absorb, quantum_noise, electronic_noise, to_log, sharpen};
    return __builtin_cpu_supports("avx2") ? &set : nullptr;
}

#else

const Set* avx2() {
    return nullptr;
}

#endif

}  // namespace cathlab::pixel_loops
