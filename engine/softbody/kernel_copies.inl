// All copies of the loops for one instruction set: TARGET is its function attribute, BLOCK the doubles of its vectors, FLOATS
// their floats.
using Block = double __attribute__((vector_size(BLOCK * sizeof(double))));
using Pair = double __attribute__((vector_size(2 * sizeof(double))));

// Places of BLOCK particles, one a lane.  x and y of a particle come in one load.
TARGET static inline void places(const double* from, const std::int32_t* place, Block& x, Block& y, Block& z) {
    const double* p[BLOCK];
    Pair xy[BLOCK];
    for (int l = 0; l < BLOCK; ++l) {
        p[l] = from + place[l];
        __builtin_memcpy(&xy[l], p[l], sizeof(Pair));
    }
#if BLOCK == 2
    x = __builtin_shufflevector(xy[0], xy[1], 0, 2);
    y = __builtin_shufflevector(xy[0], xy[1], 1, 3);
    z = Block{p[0][2], p[1][2]};
#else
    const Block even = __builtin_shufflevector(xy[0], xy[2], 0, 1, 2, 3);
    const Block odd = __builtin_shufflevector(xy[1], xy[3], 0, 1, 2, 3);
    x = __builtin_shufflevector(even, odd, 0, 4, 2, 6);
    y = __builtin_shufflevector(even, odd, 1, 5, 3, 7);
    z = Block{p[0][2], p[1][2], p[2][2], p[3][2]};
#endif
}

#define REAL double
#define WIDTH BLOCK
#define JOINED 0
#define SQRT __builtin_sqrt
#define NAMED(x) x##_double
#include "softbody/kernel.inl"
#undef REAL
#undef WIDTH
#undef JOINED
#undef SQRT
#undef NAMED
#define REAL float
#define WIDTH FLOATS
#define JOINED 1
#define SQRT __builtin_sqrtf
#define NAMED(x) x##_float
#include "softbody/kernel.inl"
#undef REAL
#undef WIDTH
#undef JOINED
#undef SQRT
#undef NAMED
#define GATHER gather_goals
#include "softbody/gather.inl"
#undef GATHER
#include "softbody/particles.inl"
#include "softbody/elastic.inl"
