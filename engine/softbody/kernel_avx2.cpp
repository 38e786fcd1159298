#include "softbody/kernel.h"

namespace cathlab::kernel {

#if defined(__x86_64__)

namespace {
#define TARGET __attribute__((target("avx2,fma")))
#define BLOCK 4
#define HAS_FMA 1
#define FLOATS 8
#include "softbody/kernel_copies.inl"
}  // namespace

const Set* avx2() {
    static const Set set{"AVX2",      fit_double,        fit_float,       gather_double,    gather_float,
                         to_grid,     predict_particles, apply_particles, finish_particles, shell_forces,
                         shell_goals, polar_of_double,   polar_of_float};
    return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") ? &set : nullptr;
}

#else

const Set* avx2() {
    return nullptr;
}

#endif

}  // namespace cathlab::kernel
