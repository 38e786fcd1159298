// The gather of goals from transforms in whole numbers, included once an instruction set, as kernel.inl is.
using Column = double __attribute__((vector_size(4 * sizeof(double))));
using Signed = std::int32_t __attribute__((vector_size(4 * sizeof(std::int32_t))));
// Without a sign: sums go round, which signed numbers must not.
using Whole = std::uint32_t __attribute__((vector_size(4 * sizeof(std::uint32_t))));
using WholeTwo = std::uint32_t __attribute__((vector_size(8 * sizeof(std::uint32_t))));

// Four whole numbers as doubles.  (The compiler's own conversion of a vector goes by halves.)
#if BLOCK == 4
#define AS_DOUBLE(numbers) __builtin_ia32_cvtdq2pd256((Signed)(numbers))
#else
#define AS_DOUBLE(numbers) __builtin_convertvector((Signed)(numbers), Column)
#endif

// Each goal's number among those that are a turn over the number of clusters apart that is nearest to x.
inline void nearest_turns(const double* share, const double* x, double* goal, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
        for (std::size_t k = 3 * i; k < 3 * i + 3; ++k) {
            const double turn = grid_turn_mm * share[i];
            goal[k] -= turn * __builtin_floor((goal[k] - x[k]) / turn + 0.5);
        }
}

#define ADD_TRANSFORM(offset)                                                    \
    {                                                                            \
        const auto at = static_cast<std::size_t>(static_cast<unsigned>(offset)); \
        WholeTwo in_xy;                                                          \
        Whole in_z;                                                              \
        __builtin_memcpy(&in_xy, base + at, sizeof in_xy);                       \
        __builtin_memcpy(&in_z, base_z + at, sizeof in_z);                       \
        xy += in_xy;                                                             \
        z += in_z;                                                               \
    }
TARGET static void gather_float(const Goals& goals, const void* transform, const double* rest, const double* x_now,
                                double* goal, std::size_t begin, std::size_t end) {
    const std::int32_t *const all = goals.from, *const first = goals.first;
    const double* const share = goals.share;
    const char *const base = static_cast<const char*>(transform), *const base_z = base + sizeof(WholeTwo);
    const double part = 1.0 / (goals.rotation_unit * grid_mm);
    const std::int32_t* from = all + first[begin];
    for (std::size_t i = begin; i < end; ++i) {
        WholeTwo xy = {};
        Whole z = {};
        const std::int32_t* const last = all + first[i + 1];
        do {  // in fours: the fewer ways to go, the better the processor foresees them
            ADD_TRANSFORM(from[0])
            ADD_TRANSFORM(from[1])
            ADD_TRANSFORM(from[2])
            ADD_TRANSFORM(from[3])
            from += 4;
        } while (from != last);
        const Whole x = __builtin_shufflevector(xy, xy, 0, 1, 2, 3), y = __builtin_shufflevector(xy, xy, 4, 5, 6, 7);
        const Whole high = __builtin_shufflevector(x, y, 2, 3, 6, 7);
        const Column moved = AS_DOUBLE(__builtin_shufflevector(high, z, 1, 3, 7, 7));
        const double* point = rest + 3 * i;
        const Column turned = AS_DOUBLE(x) * point[0] + AS_DOUBLE(y) * point[1] + AS_DOUBLE(z) * point[2];
        const Column mean = grid_mm * share[i] * (part * turned + moved);
        const Pair first_two = __builtin_shufflevector(mean, mean, 0, 1);
        __builtin_memcpy(goal + 3 * i, &first_two, sizeof first_two);
        goal[3 * i + 2] = mean[2];
    }
    if (x_now) nearest_turns(share, x_now, goal, begin, end);
}
#undef ADD_TRANSFORM
#undef AS_DOUBLE

TARGET static void to_grid(const double* numbers, std::int32_t* steps, std::size_t begin, std::size_t end) {
    std::size_t i = begin;
    for (; i + 4 <= end; i += 4) {
        Column sum;
        __builtin_memcpy(&sum, numbers + i, sizeof sum);
        sum += grid_magic;
        WholeTwo bits;
        __builtin_memcpy(&bits, &sum, sizeof bits);
        const Whole low = __builtin_shufflevector(bits, bits, 0, 2, 4, 6);
        __builtin_memcpy(steps + i, &low, sizeof low);
    }
    for (; i < end; ++i) {
        const double sum = numbers[i] + grid_magic;
        __builtin_memcpy(&steps[i], &sum, sizeof(std::int32_t));
    }
}
