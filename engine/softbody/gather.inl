// The gather of goals from transforms in double, included once an instruction set, as kernel.inl is.
// A transform's twelve numbers are added side by side, so their order of summation does not depend on the width.
#define ADD_TRANSFORM(x, y, z, offset)                                       \
    {                                                                        \
        const char* column = static_cast<const char*>(transform) + (offset); \
        Column in_x, in_y, in_z; /* an array would go through memory */      \
        __builtin_memcpy(&in_x, column, sizeof in_x);                        \
        __builtin_memcpy(&in_y, column + sizeof in_x, sizeof in_y);          \
        __builtin_memcpy(&in_z, column + 2 * sizeof in_x, sizeof in_z);      \
        (x) += in_x;                                                         \
        (y) += in_y;                                                         \
        (z) += in_z;                                                         \
    }
TARGET static void gather_double(const Goals& goals, const void* transform, const double* rest, const double*,
                                 double* goal, std::size_t begin, std::size_t end) {
    using Column = double __attribute__((vector_size(4 * sizeof(double))));
    const std::int32_t *const all = goals.from, *const first = goals.first;
    const double* const share = goals.share;
    const std::int32_t* from = all + first[begin];
    for (std::size_t i = begin; i < end; ++i) {
        // Even and odd clusters have sums of their own: one chain of additions would wait on itself.
        Column x = {}, y = {}, z = {}, odd_x = {}, odd_y = {}, odd_z = {};
        const std::int32_t* const last = all + first[i + 1];
        do {  // in fours: the fewer ways to go, the better the processor foresees them
            ADD_TRANSFORM(x, y, z, from[0])
            ADD_TRANSFORM(odd_x, odd_y, odd_z, from[1])
            ADD_TRANSFORM(x, y, z, from[2])
            ADD_TRANSFORM(odd_x, odd_y, odd_z, from[3])
            from += 4;
        } while (from != last);
        x += odd_x;
        y += odd_y;
        z += odd_z;
        const double* point = rest + 3 * i;
        const Column high = __builtin_shufflevector(x, y, 1, 5, 3, 7), t = __builtin_shufflevector(high, z, 2, 3, 6, 7);
        const Column moved = __builtin_shufflevector(t, t, 0, 1, 3, 3);
        const Column mean = share[i] * ((x * point[0] + y * point[1] + z * point[2]) + moved);
        const Pair first_two = __builtin_shufflevector(mean, mean, 0, 1);
        __builtin_memcpy(goal + 3 * i, &first_two, sizeof first_two);
        goal[3 * i + 2] = mean[2];
    }
}
#undef ADD_TRANSFORM
