// All loops for one instruction set: TARGET is its function attribute.
TARGET static void add_depths(const double* slope, std::size_t count, const PlaneInRow& plane, float* __restrict depth,
                              float* __restrict exits) {
    const double per_slope = plane.per_slope, at_zero = plane.at_zero, least = plane.least, most = plane.most;
    const double reference = plane.reference;
    const float sign = plane.sign;
    for (std::size_t i = 0; i < count; ++i) {
        const double met = per_slope * slope[i] + at_zero;
        const double above = least < met ? met : least;
        const double within = above < most ? above : most;
        depth[i] += sign * static_cast<float>(1.0 / within - reference);
        exits[i] += sign;
    }
}

TARGET static void attenuate(const float* transmission, std::size_t count, float* __restrict exponent) {
    for (std::size_t n = 0; n < count; ++n) exponent[n] = transmission[n] * fast_exp(-exponent[n]);
}

using Bins = float __attribute__((vector_size(bins * sizeof(float)), aligned(4)));
using Wholes = std::int32_t __attribute__((vector_size(bins * sizeof(float)), aligned(4)));

// transmission * fast_exp(-exponent), bin by bin, in place of the exponent.
TARGET static inline void attenuate_bins(const float* transmission, Bins& exponent) {
    const Bins bounded = exponent > 87.0F ? Bins{} + 87.0F : exponent;
    const Bins x = bounded < -87.0F ? Bins{} + 87.0F : -bounded;
    const Bins t = x * 1.44269504F;
    const Wholes whole = __builtin_convertvector(t + (t < 0.0F ? Bins{} - 0.5F : Bins{} + 0.5F), Wholes);
    const Bins f = (t - __builtin_convertvector(whole, Bins)) * 0.69314718F;
    const Bins p =
        1.0F + f * (1.0F + f * (0.5F + f * (1.0F / 6 + f * (1.0F / 24 + f * (1.0F / 120 + f * (1.0F / 720))))));
    const Wholes power = (whole + 127) << 23;
    Bins scale, passed;
    __builtin_memcpy(&scale, &power, sizeof scale);
    __builtin_memcpy(&passed, transmission, sizeof passed);
    exponent = passed * (p * scale);
}

TARGET static void pass_context(const Absorber* absorbers, std::size_t absorber_count, const float* weights,
                                const float* geometry, std::size_t begin, std::size_t end,
                                float* __restrict transmission, float* __restrict out) {
    Bins weight;
    __builtin_memcpy(&weight, weights, sizeof weight);
    // One absorber after another in blocks: pictures read side by side fall on the same lines of the cache.
    constexpr std::size_t block = 128;
    Bins left[block];
    for (std::size_t from = begin; from < end; from += block) {
        const std::size_t count = end - from < block ? end - from : block;
        for (std::size_t i = 0; i < count; ++i) left[i] = Bins{};
        for (std::size_t p = 0; p < absorber_count; ++p) {
            Bins mu;
            __builtin_memcpy(&mu, absorbers[p].mu, sizeof mu);
            const float* amount = absorbers[p].amount + from;
            for (std::size_t i = 0; i < count; ++i) {
                if (amount[i] == 0.0F) continue;
                left[i] += mu * amount[i];
            }
        }
        for (std::size_t i = 0; i < count; ++i) {
            const Bins open = weight * geometry[from + i];
            float unobstructed[bins];
            __builtin_memcpy(unobstructed, &open, sizeof open);
            Bins passed = left[i];
            attenuate_bins(unobstructed, passed);
            __builtin_memcpy(transmission + bins * (from + i), &passed, sizeof passed);
            out[from + i] = ((passed[0] + passed[4]) + (passed[2] + passed[6])) +
                            ((passed[1] + passed[5]) + (passed[3] + passed[7]));
        }
    }
}

// Each pixel's sum in the order of its taps, four of them a turn: blocks of it stay in the first cache.
TARGET static void weigh(const float* const* rows, const float* weights, std::size_t taps, std::size_t count,
                         float* __restrict out) {
    constexpr std::size_t block = 512;
    for (std::size_t from = 0; from < count; from += block) {
        const std::size_t length = count - from < block ? count - from : block;
        float* __restrict to = out + from;
        for (std::size_t i = 0; i < length; ++i) to[i] = 0.0F;
        std::size_t k = 0;
        for (; k + 4 <= taps; k += 4) {
            const float *r0 = rows[k] + from, *r1 = rows[k + 1] + from, *r2 = rows[k + 2] + from,
                        *r3 = rows[k + 3] + from;
            const float w0 = weights[k], w1 = weights[k + 1], w2 = weights[k + 2], w3 = weights[k + 3];
            for (std::size_t i = 0; i < length; ++i)
                to[i] = (((to[i] + w0 * r0[i]) + w1 * r1[i]) + w2 * r2[i]) + w3 * r3[i];
        }
        for (; k < taps; ++k) {
            const float* row = rows[k] + from;
            const float weight = weights[k];
            for (std::size_t i = 0; i < length; ++i) to[i] += weight * row[i];
        }
    }
}

TARGET static void absorb(const Absorber* absorbers, std::size_t absorber_count, const float* transmission,
                          const float* untouched, const float* scatter, std::size_t begin, std::size_t end,
                          float* __restrict out) {
    for (std::size_t i = begin; i < end; ++i) {
        Bins left{};
        bool touched = false;
        for (std::size_t p = 0; p < absorber_count; ++p) {
            const float amount = absorbers[p].amount[i];
            if (amount == 0.0F) continue;
            touched = true;
            Bins mu;
            __builtin_memcpy(&mu, absorbers[p].mu, sizeof mu);
            left += mu * amount;
        }
        if (!touched) {
            out[i] = untouched[i] + scatter[i];
            continue;
        }
        attenuate_bins(transmission + bins * i, left);
        out[i] =
            (((left[0] + left[4]) + (left[2] + left[6])) + ((left[1] + left[5]) + (left[3] + left[7]))) + scatter[i];
    }
}

TARGET static void quantum_noise(std::uint64_t key, std::uint32_t first, std::size_t count, float* __restrict photons) {
    for (std::size_t x = 0; x < count; ++x) {
        const float n = photons[x];
        const float noisy = n + __builtin_sqrtf(n) * normal_of(key, first + static_cast<std::uint32_t>(x));
        photons[x] = noisy > 0.0F ? noisy : 0.0F;
    }
}

TARGET static void electronic_noise(std::uint64_t key, float sigma, std::uint32_t first, std::size_t count,
                                    float* __restrict photons) {
    for (std::size_t x = 0; x < count; ++x) photons[x] += sigma * normal_of(key, first + static_cast<std::uint32_t>(x));
}

TARGET static void to_log(const float* history, const float* coarse, float unit, float even, float mean,
                          std::size_t count, float* __restrict out) {
    for (std::size_t i = 0; i < count; ++i) {
        const float relative = history[i] * unit;
        out[i] = fast_log(relative > 0.004F ? relative : 0.004F) - even * (coarse[i] - mean);
    }
}

TARGET static void sharpen(const float* padded, const float* above, const float* below, float edge, float scale,
                           float offset, std::size_t count, std::uint8_t* __restrict out) {
    for (std::size_t x = 0; x < count; ++x) {
        const float here = padded[x + 1];
        const float sharp = here + edge * (4.0F * here - padded[x] - padded[x + 2] - above[x] - below[x]);
        const float value = offset + scale * sharp + 0.5F;
        const float low = value < 0.0F ? 0.0F : value;
        out[x] = static_cast<std::uint8_t>(static_cast<std::int32_t>(low > 255.0F ? 255.0F : low));
    }
}
