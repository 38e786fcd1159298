#include "softbody/kernel.h"

namespace cathlab::kernel {

namespace {
#define TARGET
#define BLOCK 2
#define HAS_FMA 0
#define FLOATS 4
#include "softbody/kernel_copies.inl"
}  // namespace

const Set& baseline() {
    static const Set set{"SSE2",      fit_double,        fit_float,       gather_double,    gather_float,
                         to_grid,     predict_particles, apply_particles, finish_particles, shell_forces,
                         shell_goals, polar_of_double,   polar_of_float};
    return set;
}

void limit_way(const double* start, double farthest, double* x) {
    const double way[3] = {x[0] - start[0], x[1] - start[1], x[2] - start[2]};
    const double squared = way[0] * way[0] + (way[1] * way[1] + way[2] * way[2]);
    if (!(squared > farthest * farthest)) return;
    const double share = farthest / __builtin_sqrt(squared);
    for (int k = 0; k < 3; ++k) x[k] = start[k] + share * way[k];
}

const Set& best() {
    const Set* wide = avx2();
    return wide ? *wide : baseline();
}

}  // namespace cathlab::kernel
