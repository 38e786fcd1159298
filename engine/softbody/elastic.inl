// Forces of the elastic shell (shell.h), included once an instruction set, as gather.inl is: one lane holds one
// triangle.
using Bits = std::int64_t __attribute__((vector_size(BLOCK * sizeof(std::int64_t))));
struct Vector {  // one of each lane
    Block x, y, z;
};
#define ELASTIC_INLINE TARGET static inline __attribute__((always_inline))
ELASTIC_INLINE Block of_vector(const Vector& a, const Vector& b) {
    return a.x * b.x + (a.y * b.y + a.z * b.z);
}
ELASTIC_INLINE void all_lanes(double value, Block& to) {
    to = Block{} + value;
}
ELASTIC_INLINE void lanes_at(const double* from, Block& to) {
    __builtin_memcpy(&to, from, sizeof to);
}
ELASTIC_INLINE void put_lanes(const Block& from, double* to) {
    __builtin_memcpy(to, &from, sizeof from);
}
ELASTIC_INLINE void vector_at(const double* from, const std::int32_t* place, Vector& to) {
    places_double(from, place, to.x, to.y, to.z);
}

// ln x for normal x > 0, to 2 ulp: x = m 2^e with m near 1, ln m = 2 artanh((m - 1) / (m + 1)).
ELASTIC_INLINE Block logarithm(const Block& x) {
    Bits bits;
    __builtin_memcpy(&bits, &x, sizeof bits);
    const Bits two_to_52 = Bits{} + 0x4330000000000000;
    const Bits biased = ((bits >> 52) & 0x7ff) | two_to_52;
    const Bits fraction = (bits & 0x000fffffffffffff) | 0x3ff0000000000000;
    Block e, m;
    __builtin_memcpy(&e, &biased, sizeof e);
    __builtin_memcpy(&m, &fraction, sizeof m);
    e -= 4503599627370496.0 + 1023.0;
    const auto high = m > 1.4142135623730951;
    m = high ? 0.5 * m : m;
    e = high ? e + 1.0 : e;
    const Block s = (m - 1.0) / (m + 1.0), z = s * s;
    // Terms in pairs, pairs in fours: a chain of ten would wait on itself.
    const Block z2 = z * z, z4 = z2 * z2;
    const Block low = (1.0 / 3.0 + z * (1.0 / 5.0)) + z2 * (1.0 / 7.0 + z * (1.0 / 9.0));
    const Block middle = (1.0 / 11.0 + z * (1.0 / 13.0)) + z2 * (1.0 / 15.0 + z * (1.0 / 17.0));
    const Block sum = (low + z4 * middle) + (z4 * z4) * (1.0 / 19.0 + z * (1.0 / 21.0));
    // e ln 2 in two parts: the first has no rounding.
    return e * 0.693147180369123816490 + (2.0 * s + (2.0 * s * z * sum + e * 1.90821492927058770002e-10));
}

// e^x for |x| < 700, to 2 ulp: x = n ln 2 + r, Taylor's series of r.
ELASTIC_INLINE Block exponential(const Block& x) {
    const double shifter = 6755399441055744.0;  // 1.5 2^52: what is added to it is rounded to a whole number
    const Block shifted = x * 1.44269504088896340736 + shifter;
    const Block n = shifted - shifter;
    const Block r = (x - n * 0.693147180369123816490) - n * 1.90821492927058770002e-10;
    const Block r2 = r * r, r4 = r2 * r2;
    const Block low = (1.0 + r) + r2 * (1.0 / 2.0 + r * (1.0 / 6.0));
    const Block middle = (1.0 / 24.0 + r * (1.0 / 120.0)) + r2 * (1.0 / 720.0 + r * (1.0 / 5040.0));
    const Block high = (1.0 / 40320.0 + r * (1.0 / 362880.0)) + r2 * (1.0 / 3628800.0 + r * (1.0 / 39916800.0));
    const Block sum = (low + r4 * middle) + (r4 * r4) * (high + r4 * (1.0 / 479001600.0));
    Bits bits;
    __builtin_memcpy(&bits, &shifted, sizeof bits);
    bits = (bits + 1023) << 52;
    Block scale;
    __builtin_memcpy(&scale, &bits, sizeof scale);
    return sum * scale;
}

// Adds one family's stress (times its volume) to s, and what it adds to the membrane's stiffness to `stiffer`.
ELASTIC_INLINE void add_fibres(const Elastic& e, double sine, const Block& round_x, const Block& round_y,
                               const Block* c, const Block& volume, Block* s, Block& stiffer) {
    const Block along = round_x * e.fibre_cosine - round_y * sine, across = round_y * e.fibre_cosine + round_x * sine;
    const Block h11 = 0.5 + along, h22 = 0.5 - along;
    const Block strain = h11 * c[0] + (h22 * c[2] + 2.0 * (across * c[1])) - (1.0 + e.fibre_onset);
    const auto pulled = strain > 0.0;
    const Block positive = pulled ? strain : Block{};
    const Block held = positive < e.fibre_limit ? positive : Block{} + e.fibre_limit;
    const Block square = e.fibre_exponent * (held * held);
    const Block grown = e.fibre_stiffness * exponential(square);
    const Block slope = pulled ? grown * (1.0 + 2.0 * square) : Block{};
    const Block twice = 2.0 * volume * (grown * held + slope * (positive - held));
    s[0] += twice * h11;
    s[1] += twice * across;
    s[2] += twice * h22;
    stiffer += twice + 4.0 * volume * slope * (c[0] + c[2]) * (h11 * h11 + (h22 * h22 + 2.0 * (across * across)));
}

TARGET static void shell_forces(const Elastic& given, const double* x, double* slot_force, double* tangent,
                                std::size_t begin, std::size_t end) {
    const Elastic e = given;  // a store to an array could, for all that the compiler knows, change the original
    for (std::size_t g = begin; g < end; ++g) {
        const auto first = static_cast<std::size_t>(e.first_slot[g]),
                   last = static_cast<std::size_t>(e.first_slot[g + 1]);
        for (std::size_t half = 0; half < lanes; half += BLOCK) {
            const double* const constant = e.constant + g * elastic_constants * lanes + half;
            Vector origin, f1, f2, p;
            vector_at(x, e.place + first * lanes + half, origin);
            vector_at(x, e.place + (first + 1) * lanes + half, f1);
            vector_at(x, e.place + (first + 2) * lanes + half, f2);
            f1 = {f1.x - origin.x, f1.y - origin.y, f1.z - origin.z};
            f2 = {f2.x - origin.x, f2.y - origin.y, f2.z - origin.z};
            // Second derivatives of position.
            Vector b11{}, b22{}, b12{};
            Block w;
            for (std::size_t slot = first + 1; slot < last; ++slot) {
                vector_at(x, e.place + slot * lanes + half, p);
                p = {p.x - origin.x, p.y - origin.y, p.z - origin.z};
                const double* const weight = e.second + slot * 3 * lanes + half;
                lanes_at(weight, w);
                b11 = {b11.x + w * p.x, b11.y + w * p.y, b11.z + w * p.z};
                lanes_at(weight + lanes, w);
                b22 = {b22.x + w * p.x, b22.y + w * p.y, b22.z + w * p.z};
                lanes_at(weight + 2 * lanes, w);
                b12 = {b12.x + w * p.x, b12.y + w * p.y, b12.z + w * p.z};
            }
            Block r00, r01, r11, membrane, thinning, volume, bending, poisson, k11, k22, k12, round_x, round_y;
            lanes_at(constant, r00);
            lanes_at(constant + lanes, r01);
            lanes_at(constant + 2 * lanes, r11);
            lanes_at(constant + 3 * lanes, membrane);
            lanes_at(constant + 4 * lanes, thinning);
            lanes_at(constant + 5 * lanes, volume);
            lanes_at(constant + 6 * lanes, bending);
            lanes_at(constant + 7 * lanes, poisson);
            lanes_at(constant + 8 * lanes, k11);
            lanes_at(constant + 9 * lanes, k22);
            lanes_at(constant + 10 * lanes, k12);
            lanes_at(constant + 11 * lanes, round_x);
            lanes_at(constant + 12 * lanes, round_y);
            if (e.scale) {
                Block scale;
                for (std::size_t l = 0; l < BLOCK; ++l) {
                    double sum = 0.0;
                    for (std::size_t k = 0; k < 3; ++k) sum += e.scale[e.place[(first + k) * lanes + half + l] / 3];
                    scale[l] = sum * (1.0 / 3.0);
                }
                membrane *= scale;
                volume *= scale;
                bending *= scale;
            }
            // F, from the edges, and C.
            f2 = {f1.x * r01 + f2.x * r11, f1.y * r01 + f2.y * r11, f1.z * r01 + f2.z * r11};
            f1 = {f1.x * r00, f1.y * r00, f1.z * r00};
            const Block c[3] = {of_vector(f1, f1), of_vector(f1, f2), of_vector(f2, f2)};
            Block d = c[0] * c[2] - c[1] * c[1];
            d = d > elastic_least_det ? d : Block{} + elastic_least_det;
            const Block inverse = 1.0 / d, i11 = c[2] * inverse, i12 = -c[1] * inverse, i22 = c[0] * inverse;
            const Block thinner = exponential(-thinning * logarithm(d));
            Block s[3] = {membrane * (1.0 - thinner * i11), -membrane * (thinner * i12),
                          membrane * (1.0 - thinner * i22)};
            // How much stiffer than at rest: a wall pressed together, and fibres, are.
            const Block at_rest = 2.0 * (membrane * (1.0 + 2.0 * thinning));
            Block stiffer = at_rest * (thinner > 1.0 ? thinner : Block{} + 1.0);
            if (e.fibre_stiffness > 0.0) {
                add_fibres(e, e.fibre_sine, round_x, round_y, c, volume, s, stiffer);
                add_fibres(e, -e.fibre_sine, round_x, round_y, c, volume, s, stiffer);
            }
            if (e.law) {
                const double* const law = e.law + g * 4 * lanes + half;
                Block times, more;
                lanes_at(law, times);
                stiffer *= times > 1.0 ? times : Block{} + 1.0;
                for (std::size_t k = 0; k < 3; ++k) {
                    lanes_at(law + (k + 1) * lanes, more);
                    Block& to = s[k == 0 ? 0 : 3 - k];  // 11, 22, 12 there, 11, 12, 22 here
                    to = times * to + volume * more;
                }
            }
            Block factor = stiffer / at_rest;
            if (e.scale) {
                Block unscaled;
                lanes_at(constant + 3 * lanes, unscaled);
                factor *= membrane / unscaled;
            }
            put_lanes(factor, tangent + g * lanes + half);
            // Normal and moment.
            Vector n{f1.y * f2.z - f1.z * f2.y, f1.z * f2.x - f1.x * f2.z, f1.x * f2.y - f1.y * f2.x};
            Block length = of_vector(n, n);
            for (std::size_t l = 0; l < BLOCK; ++l) length[l] = __builtin_sqrt(length[l]);
            const Block shorten = 1.0 / (length > 1e-300 ? length : Block{} + 1e-300);
            n = {n.x * shorten, n.y * shorten, n.z * shorten};
            k11 = of_vector(b11, n) - k11;
            k22 = of_vector(b22, n) - k22;
            k12 = of_vector(b12, n) - k12;
            const Block m11 = bending * (k11 + poisson * k22), m22 = bending * (k22 + poisson * k11),
                        m12 = bending * (2.0 * ((1.0 - poisson) * k12));
            const Vector bm{b11.x * m11 + b22.x * m22 + b12.x * m12, b11.y * m11 + b22.y * m22 + b12.y * m12,
                            b11.z * m11 + b22.z * m22 + b12.z * m12};
            // The normal turns with the triangle: dn = - sum over g of (n . da_g) a^g.
            const Block q1 = of_vector(f1, bm), q2 = of_vector(f2, bm);
            const Block t1 = i11 * q1 + i12 * q2, t2 = i12 * q1 + i22 * q2;
            const Vector u1{f1.x * s[0] + f2.x * s[1], f1.y * s[0] + f2.y * s[1], f1.z * s[0] + f2.z * s[1]},
                u2{f1.x * s[1] + f2.x * s[2], f1.y * s[1] + f2.y * s[2], f1.z * s[1] + f2.z * s[2]};
            const Block turn1 = r00 * t1 + r01 * t2, turn2 = r11 * t2;
            const Vector on1{n.x * turn1 - (u1.x * r00 + u2.x * r01), n.y * turn1 - (u1.y * r00 + u2.y * r01),
                             n.z * turn1 - (u1.z * r00 + u2.z * r01)};
            const Vector on2{n.x * turn2 - u2.x * r11, n.y * turn2 - u2.y * r11, n.z * turn2 - u2.z * r11};
            for (std::size_t slot = first; slot < last; ++slot) {
                const double* const weight = e.second + slot * 3 * lanes + half;
                Block w11, w22, w12;
                lanes_at(weight, w11);
                lanes_at(weight + lanes, w22);
                lanes_at(weight + 2 * lanes, w12);
                const Block across = -(w11 * m11 + w22 * m22 + w12 * m12);
                Vector f{n.x * across, n.y * across, n.z * across};
                if (slot == first)
                    f = {f.x - (on1.x + on2.x), f.y - (on1.y + on2.y), f.z - (on1.z + on2.z)};
                else if (slot == first + 1)
                    f = {f.x + on1.x, f.y + on1.y, f.z + on1.z};
                else if (slot == first + 2)
                    f = {f.x + on2.x, f.y + on2.y, f.z + on2.z};
                double* const out = slot_force + slot * 3 * lanes + half;
                put_lanes(f.x, out);
                put_lanes(f.y, out + lanes);
                put_lanes(f.z, out + 2 * lanes);
            }
        }
    }
}

// goal = x + force / stiffness, the force summed over the particle's slots.
TARGET static void shell_goals(const ElasticSources& s, const double* slot_force, const double* x,
                               const double* stiffness, double* goal, std::size_t begin, std::size_t end) {
    const std::int32_t *const all = s.from, *const first = s.first;
    for (std::size_t i = begin; i < end; ++i) {
        double fx = 0.0, fy = 0.0, fz = 0.0;
        for (std::int32_t k = first[i]; k < first[i + 1]; ++k) {
            const double* const from = slot_force + all[k];
            fx += from[0];
            fy += from[lanes];
            fz += from[2 * lanes];
        }
        const double share = 1.0 / stiffness[i];
        goal[3 * i] = x[3 * i] + share * fx;
        goal[3 * i + 1] = x[3 * i + 1] + share * fy;
        goal[3 * i + 2] = x[3 * i + 2] + share * fz;
    }
}
#undef ELASTIC_INLINE
