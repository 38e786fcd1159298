// All copies of the loops for one instruction set: TARGET is its function attribute, BLOCK the doubles of its vectors,
// FLOATS their floats.
using Block = double __attribute__((vector_size(BLOCK * sizeof(double))));
using Pair = double __attribute__((vector_size(2 * sizeof(double))));

// Places of BLOCK particles, one a lane.  x and y of a particle come in one load.
TARGET static inline void places_double(const double* from, const std::int32_t* place, Block& x, Block& y, Block& z) {
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

#if !HAS_FMA
using FloatPart = float __attribute__((vector_size(FLOATS * sizeof(float))));
using DoublePart = double __attribute__((vector_size(FLOATS * sizeof(double))));
using BitsPart = std::int64_t __attribute__((vector_size(FLOATS * sizeof(std::int64_t))));
// a b + c, rounded once: the product is exact in double, and a sum rounded to odd is rounded to float as the true one
// would be (Boldo, Melquiond 2008).
TARGET static inline void fused(const FloatPart& a, const FloatPart& b, FloatPart& c) {
    const DoublePart product = __builtin_convertvector(a, DoublePart) * __builtin_convertvector(b, DoublePart);
    const DoublePart add = __builtin_convertvector(c, DoublePart);
    const DoublePart sum = product + add, of_add = sum - product;
    const DoublePart lost = (product - (sum - of_add)) + (add - of_add);
    BitsPart bits;
    __builtin_memcpy(&bits, &sum, sizeof bits);
    const BitsPart away = (lost > 0.0) == (sum > 0.0);  // -1 where the true sum is the larger in size
    const BitsPart even = (bits & 1) == 0;
    bits += (lost != 0.0) & even & (away ? BitsPart{} + 1 : BitsPart{} - 1);
    DoublePart odd;
    __builtin_memcpy(&odd, &bits, sizeof odd);
    c = __builtin_convertvector(odd, FloatPart);
}
#endif

#define ADD_PRODUCT(a, b, c) ((a) * (b) + (c))
#define REAL double
#define WIDTH BLOCK
#define ON_GRID 0
#define SQRT __builtin_sqrt
#define NAMED(x) x##_double
#include "softbody/kernel.inl"
#undef REAL
#undef WIDTH
#undef ON_GRID
#undef SQRT
#undef NAMED
#undef ADD_PRODUCT
#if HAS_FMA
#define ADD_PRODUCT(a, b, c) __builtin_ia32_vfmaddps256(a, b, c)
#else
#define ADD_PRODUCT(a, b, c) (fused(a, b, c), (c))
#endif
#define REAL float
#define WIDTH FLOATS
#define ON_GRID 1
#define SQRT __builtin_sqrtf
#define NAMED(x) x##_float
#include "softbody/kernel.inl"
#undef REAL
#undef WIDTH
#undef ON_GRID
#undef SQRT
#undef NAMED
#undef ADD_PRODUCT
#include "softbody/elastic.inl"
#include "softbody/gather.inl"
#include "softbody/gather_grid.inl"
#include "softbody/particles.inl"
