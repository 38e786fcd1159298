// All copies of the loops for one instruction set: TARGET, DOUBLES and FLOATS (lanes of a vector), GATHER_WIDTH, SUFFIX-ed names.
#define REAL double
#define WIDTH DOUBLES
#define SQRT __builtin_sqrt
#define NAMED(x) x##_double
#include "softbody/kernel.inl"
#undef REAL
#undef WIDTH
#undef SQRT
#undef NAMED
#define REAL float
#define WIDTH FLOATS
#define SQRT __builtin_sqrtf
#define NAMED(x) x##_float
#include "softbody/kernel.inl"
#undef REAL
#undef WIDTH
#undef SQRT
#undef NAMED
#define GATHER gather_goals
#include "softbody/gather.inl"
#undef GATHER
