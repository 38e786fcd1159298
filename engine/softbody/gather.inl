// The gather of goals, included once an instruction set, as kernel.inl is: GATHER its name.
// The twelve numbers of a transform are added side by side, so their order of summation does not depend on the width.
TARGET static void GATHER(const std::int32_t* start, const std::int32_t* cluster, const double* transform,
                          const double* rest, double* goal, std::size_t begin, std::size_t end) {
    constexpr std::size_t pieces = transform_doubles / BLOCK;
    for (std::size_t i = begin; i < end; ++i) {
        // Even and odd clusters have sums of their own: one chain of additions would wait on itself.
        Block sum[pieces] = {}, odd[pieces] = {};
        std::int32_t m = start[i];
        for (; m + 1 < start[i + 1]; m += 2) {
            const double* from = transform + static_cast<std::size_t>(cluster[m]) * transform_doubles;
            const double* next = transform + static_cast<std::size_t>(cluster[m + 1]) * transform_doubles;
            for (std::size_t p = 0; p < pieces; ++p) {
                Block part, other;
                __builtin_memcpy(&part, from + p * BLOCK, sizeof part);
                __builtin_memcpy(&other, next + p * BLOCK, sizeof other);
                sum[p] += part;
                odd[p] += other;
            }
        }
        if (m < start[i + 1]) {
            const double* from = transform + static_cast<std::size_t>(cluster[m]) * transform_doubles;
            for (std::size_t p = 0; p < pieces; ++p) {
                Block part;
                __builtin_memcpy(&part, from + p * BLOCK, sizeof part);
                sum[p] += part;
            }
        }
        for (std::size_t p = 0; p < pieces; ++p) sum[p] += odd[p];
        double mean[transform_doubles];
        __builtin_memcpy(mean, sum, sizeof mean);
        const double share = 1.0 / (start[i + 1] - start[i]);
        const double* point = rest + 3 * i;
        for (std::size_t k = 0; k < 3; ++k)
            goal[3 * i + k] =
                share * ((mean[k] * point[0] + mean[3 + k] * point[1] + mean[6 + k] * point[2]) + mean[9 + k]);
    }
}
