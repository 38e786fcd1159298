// The body of the hot loops, included once for each number type and instruction set with
//   REAL        float or double
//   WIDTH       lanes of a vector, 2, 4 or 8
//   NAMED(x)    x with the suffix of this copy
//   TARGET      the function attribute that selects the instructions
//   ADD_PRODUCT(a, b, c)  a b + c, rounded as the instruction set's own number type wants it (kernel_copies.inl)
//   ON_GRID     1 where positions and transforms are whole steps of the grid (float), 0 where they are doubles
// Plain arrays and compiler vectors only: an inline function of a library, compiled here for a newer processor, could
// be the copy that the linker keeps for everybody.

using NAMED(V) = REAL __attribute__((vector_size(WIDTH * sizeof(REAL))));

TARGET static inline void NAMED(load)(const REAL* from, NAMED(V) & to) {
    __builtin_memcpy(&to, from, sizeof to);
}

// R of the quaternion q, whatever its length: r[3 * row + column].
TARGET static inline void NAMED(matrix_of)(const NAMED(V) * q, NAMED(V) * r) {
    const NAMED(V) s = REAL(2) / (q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    const NAMED(V) sx = s * q[1], sy = s * q[2], sz = s * q[3];
    const NAMED(V) wx = sx * q[0], wy = sy * q[0], wz = sz * q[0];
    const NAMED(V) xx = sx * q[1], xy = sx * q[2], xz = sx * q[3], yy = sy * q[2], yz = sy * q[3], zz = sz * q[3];
    r[0] = REAL(1) - (yy + zz);
    r[1] = xy - wz;
    r[2] = xz + wy;
    r[3] = xy + wz;
    r[4] = REAL(1) - (xx + zz);
    r[5] = yz - wx;
    r[6] = xz - wy;
    r[7] = yz + wx;
    r[8] = REAL(1) - (xx + yy);
}

// The rotation R that maximises trace(R^T A), by iteration from q.  With M = R^T A and S its symmetric part, the turn d
// (in the frame of R) that is still missing obeys  (trace(S) 1 - S) d = axial(M)  to second order: Newton's step, taken
// where that matrix is positive definite.  Elsewhere (far away, inverted, flat, collinear, zero) the step is the one of
// Mueller et al. 2016, eq. 7, axial(M) over |trace|, which never fails.  A lane that has arrived is left alone, so it
// does not feel its neighbours.
TARGET static inline void NAMED(polar)(const NAMED(V) * a, NAMED(V) * q) {
    const REAL tiny = sizeof(REAL) == 8 ? REAL(1e-290) : REAL(1e-36);
    const REAL slack = sizeof(REAL) == 8 ? REAL(1e-10) : REAL(1e-5);
    const REAL arrived =
        sizeof(REAL) == 8 ? REAL(1e-14) : REAL(1e-8);  // square of the last turn; the error is its square
    const NAMED(V) zero = {}, one = zero + REAL(1);
    auto done = zero > one;
    // Covariances are scaled to a largest entry of 1, lest their cubes leave the range of a float.
    NAMED(V) size = zero + tiny;
    for (int k = 0; k < 9; ++k) {
        const NAMED(V) entry = a[k] < 0 ? -a[k] : a[k];
        size = entry > size ? entry : size;
    }
    NAMED(V) b[9];
    for (int k = 0; k < 9; ++k) b[k] = a[k] / size;
    for (int round = 0; round < polar_rounds; ++round) {
        NAMED(V) r[9], m[9];
        NAMED(matrix_of)(q, r);
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j) m[3 * i + j] = r[i] * b[j] + r[3 + i] * b[3 + j] + r[6 + i] * b[6 + j];
        const NAMED(V) ax = m[7] - m[5], ay = m[2] - m[6], az = m[3] - m[1];
        const NAMED(V) trace = m[0] + m[4] + m[8];
        const NAMED(V) bxy = REAL(-0.5) * (m[1] + m[3]), bxz = REAL(-0.5) * (m[2] + m[6]),
                       byz = REAL(-0.5) * (m[5] + m[7]);
        const NAMED(V) bxx = m[4] + m[8] + slack, byy = m[0] + m[8] + slack, bzz = m[0] + m[4] + slack;
        const NAMED(V) cxx = byy * bzz - byz * byz, cxy = bxz * byz - bxy * bzz, cxz = bxy * byz - bxz * byy;
        const NAMED(V) cyy = bxx * bzz - bxz * bxz, cyz = bxy * bxz - bxx * byz, czz = bxx * byy - bxy * bxy;
        const NAMED(V) det = bxx * cxx + bxy * cxy + bxz * cxz;
        const auto newton = (bxx > 0) & (czz > 0) & (det > slack);
        const NAMED(V) safe = newton ? det : one;
        const NAMED(V) magnitude = trace < 0 ? -trace : trace;
        const NAMED(V) denominator = magnitude + REAL(0.1);
        const NAMED(V) dx = newton ? (cxx * ax + cxy * ay + cxz * az) / safe : ax / denominator;
        const NAMED(V) dy = newton ? (cxy * ax + cyy * ay + cyz * az) / safe : ay / denominator;
        const NAMED(V) dz = newton ? (cxz * ax + cyz * ay + czz * az) / safe : az / denominator;
        // The half turn's tangent, held below 1/2: Newton's step is no guide over more than 53 degrees.
        const NAMED(V) turn2 = dx * dx + dy * dy + dz * dz;
        NAMED(V) bound = REAL(1) + turn2;
        for (int l = 0; l < WIDTH; ++l) bound[l] = SQRT(bound[l]);
        const NAMED(V) half = REAL(0.5) / bound;
        const NAMED(V) hx = half * dx, hy = half * dy, hz = half * dz;
        NAMED(V) n[4];
        n[0] = q[0] - q[1] * hx - q[2] * hy - q[3] * hz;
        n[1] = q[1] + q[0] * hx + q[2] * hz - q[3] * hy;
        n[2] = q[2] + q[0] * hy + q[3] * hx - q[1] * hz;
        n[3] = q[3] + q[0] * hz + q[1] * hy - q[2] * hx;
        NAMED(V) length = n[0] * n[0] + n[1] * n[1] + n[2] * n[2] + n[3] * n[3];
        for (int l = 0; l < WIDTH; ++l) length[l] = SQRT(length[l]);
        for (int k = 0; k < 4; ++k) q[k] = done ? q[k] : n[k] / length;
        done = done | ~(turn2 >= arrived);  // a turn that is no number ends it too
        bool all = true;
        for (int l = 0; l < WIDTH; ++l) all = all && done[l] != 0;
        if (all) break;
    }
}

#if ON_GRID
// Without a sign: their differences go round, which signed numbers must not.
using NAMED(Coordinate) = std::uint32_t __attribute__((vector_size(WIDTH * sizeof(std::uint32_t))));

// Places of WIDTH particles, one a lane.  All three numbers of a particle come in one load, and the next one's first.
TARGET static inline void NAMED(places)(const std::int32_t* from, const std::int32_t* place, NAMED(Coordinate) & x,
                                        NAMED(Coordinate) & y, NAMED(Coordinate) & z) {
    using Four = std::uint32_t __attribute__((vector_size(4 * sizeof(std::uint32_t))));
    Four of[WIDTH];
    for (int l = 0; l < WIDTH; ++l) __builtin_memcpy(&of[l], from + place[l], sizeof(Four));
#if WIDTH == 4
    const Four low_a = __builtin_shufflevector(of[0], of[1], 0, 4, 1, 5);
    const Four low_b = __builtin_shufflevector(of[2], of[3], 0, 4, 1, 5);
    x = __builtin_shufflevector(low_a, low_b, 0, 1, 4, 5);
    y = __builtin_shufflevector(low_a, low_b, 2, 3, 6, 7);
    z = __builtin_shufflevector(__builtin_shufflevector(of[0], of[1], 2, 6, 3, 7),
                                __builtin_shufflevector(of[2], of[3], 2, 6, 3, 7), 0, 1, 4, 5);
#else
    using Eight = NAMED(Coordinate);
    const Eight a = __builtin_shufflevector(of[0], of[4], 0, 1, 2, 3, 4, 5, 6, 7);
    const Eight b = __builtin_shufflevector(of[1], of[5], 0, 1, 2, 3, 4, 5, 6, 7);
    const Eight c = __builtin_shufflevector(of[2], of[6], 0, 1, 2, 3, 4, 5, 6, 7);
    const Eight d = __builtin_shufflevector(of[3], of[7], 0, 1, 2, 3, 4, 5, 6, 7);
    const Eight low_ab = __builtin_shufflevector(a, b, 0, 8, 1, 9, 4, 12, 5, 13);
    const Eight low_cd = __builtin_shufflevector(c, d, 0, 8, 1, 9, 4, 12, 5, 13);
    const Eight high_ab = __builtin_shufflevector(a, b, 2, 10, 3, 11, 6, 14, 7, 15);
    const Eight high_cd = __builtin_shufflevector(c, d, 2, 10, 3, 11, 6, 14, 7, 15);
    x = __builtin_shufflevector(low_ab, low_cd, 0, 1, 8, 9, 4, 5, 12, 13);
    y = __builtin_shufflevector(low_ab, low_cd, 2, 3, 10, 11, 6, 7, 14, 15);
    z = __builtin_shufflevector(high_ab, high_cd, 0, 1, 8, 9, 4, 5, 12, 13);
#endif
}

// In steps of the grid; their difference is taken modulo 2^32, so nothing is lost where the count turns over.
TARGET static inline NAMED(V) NAMED(length)(NAMED(Coordinate) steps) {
    using Signed = std::int32_t __attribute__((vector_size(WIDTH * sizeof(std::int32_t))));
    return __builtin_convertvector((Signed)steps, NAMED(V));
}

// R in whole parts of the unit, t in steps of the grid.  t is the one of the R that stands there, rounded as it is.
// Whether a sum of as many t as R's unit leaves room for could go round.
TARGET static inline bool NAMED(put_transform)(const Groups<REAL>& view, const NAMED(V) * r, const NAMED(V) * c,
                                               std::size_t l, const double* origin, const double* rest, void* transform,
                                               std::size_t lane) {
    std::int32_t* out = static_cast<std::int32_t*>(transform) + lane * transform_numbers;
    const auto unit = static_cast<REAL>(view.rotation_unit);
    const double part = 1.0 / view.rotation_unit;
    const double surely = 0.5 * grid_turn_mm * view.rotation_unit / rotation_room;
    bool far = false;
    for (std::size_t k = 0; k < 3; ++k) {
        double turned = 0.0;
        for (std::size_t j = 0; j < 3; ++j) {
            out[4 * j + k] = static_cast<std::int32_t>(unit * r[3 * k + j][l]);
            turned += static_cast<double>(out[4 * j + k]) * rest[j * lanes];
        }
        const double on_grid = (origin[k] + grid_magic) - grid_magic;
        const double moved = (on_grid + grid_mm * static_cast<double>(c[k][l])) - part * turned,
                     sum = moved + grid_magic;
        far |= !(moved < surely && moved > -surely);
        __builtin_memcpy(&out[4 * k + 3], &sum, sizeof(std::int32_t));
    }
    return far;
}
#else
using NAMED(Coordinate) = NAMED(V);

TARGET static inline NAMED(V) NAMED(length)(NAMED(Coordinate) difference) {
    return difference;
}

TARGET static inline bool NAMED(put_transform)(const Groups<REAL>&, const NAMED(V) * r, const NAMED(V) * c,
                                               std::size_t l, const double* origin, const double* rest, void* transform,
                                               std::size_t lane) {
    double* out = static_cast<double*>(transform) + lane * transform_numbers;
    for (std::size_t k = 0; k < 3; ++k) {
        const double r0 = r[3 * k][l], r1 = r[3 * k + 1][l], r2 = r[3 * k + 2][l];
        out[k] = r0;
        out[4 + k] = r1;
        out[8 + k] = r2;
        out[4 * k + 3] = (origin[k] + c[k][l]) - (r0 * rest[0] + r1 * rest[lanes] + r2 * rest[2 * lanes]);
    }
    return false;
}
#endif

TARGET static void NAMED(fit)(const void* groups, const Positions& positions, double* rotation, void* transform,
                              std::uint8_t* far, std::size_t begin, std::size_t end) {
    const Groups<REAL>& view = *static_cast<const Groups<REAL>*>(groups);
#if ON_GRID
    const std::int32_t* const x = positions.grid;
#else
    const double* const x = positions.x;
#endif
    for (std::size_t g = begin; g < end; ++g) {
        bool leads_far = false;
        const auto first = static_cast<std::size_t>(view.first_slot[g]);
        const auto last = static_cast<std::size_t>(view.first_slot[g + 1]);
        for (std::size_t half = 0; half < lanes; half += WIDTH) {
            NAMED(Coordinate) ox, oy, oz;
            NAMED(places)(x, view.place + first * lanes + half, ox, oy, oz);
            // Twelve sums by name: as arrays they would be kept in memory.
            NAMED(V) cx = {}, cy = {}, cz = {};
            NAMED(V) axx = {}, axy = {}, axz = {}, ayx = {}, ayy = {}, ayz = {}, azx = {}, azy = {}, azz = {};
            for (std::size_t slot = first; slot < last; ++slot) {
                const std::int32_t* place = view.place + slot * lanes + half;
                // The first places are the origin: a compiler that knows would load every slot's a round ahead.
                __asm__("" : "+r"(place));
                const REAL* member = view.member + slot * 4 * lanes + half;
                NAMED(V) dx, dy, dz, m;
                NAMED(Coordinate) nx, ny, nz;
                NAMED(places)(x, place, nx, ny, nz);
                dx = NAMED(length)(nx - ox);
                dy = NAMED(length)(ny - oy);
                dz = NAMED(length)(nz - oz);
                // Number by number of the member: so it is loaded once and then forgotten.
                NAMED(load)(member + 3 * lanes, m);
                cx = ADD_PRODUCT(m, dx, cx);
                cy = ADD_PRODUCT(m, dy, cy);
                cz = ADD_PRODUCT(m, dz, cz);
                NAMED(load)(member, m);
                axx = ADD_PRODUCT(dx, m, axx);
                ayx = ADD_PRODUCT(dy, m, ayx);
                azx = ADD_PRODUCT(dz, m, azx);
                NAMED(load)(member + lanes, m);
                axy = ADD_PRODUCT(dx, m, axy);
                ayy = ADD_PRODUCT(dy, m, ayy);
                azy = ADD_PRODUCT(dz, m, azy);
                NAMED(load)(member + 2 * lanes, m);
                axz = ADD_PRODUCT(dx, m, axz);
                ayz = ADD_PRODUCT(dy, m, ayz);
                azz = ADD_PRODUCT(dz, m, azz);
            }
            const NAMED(V) c[3] = {cx, cy, cz}, a[9] = {axx, axy, axz, ayx, ayy, ayz, azx, azy, azz};
            NAMED(V) q[4], r[9];
            double* turn = rotation + g * 4 * lanes + half;
            for (std::size_t k = 0; k < 4; ++k)
                for (std::size_t l = 0; l < WIDTH; ++l) q[k][l] = static_cast<REAL>(turn[k * lanes + l]);
            NAMED(polar)(a, q);
            NAMED(matrix_of)(q, r);
            for (std::size_t l = 0; l < WIDTH; ++l) {
                for (std::size_t k = 0; k < 4; ++k) turn[k * lanes + l] = static_cast<double>(q[k][l]);
                const std::size_t lane = g * lanes + (half + l);
                const double* rest = view.rest_centroid + g * 3 * lanes + half + l;
                const double* origin = positions.x + view.place[first * lanes + half + l];
                leads_far |= NAMED(put_transform)(view, r, c, l, origin, rest, transform, lane);
            }
        }
        if (far) far[g] = leads_far;
    }
}

TARGET static void NAMED(polar_of)(const double* matrix, double* quaternion) {
    for (std::size_t half = 0; half < lanes; half += WIDTH) {
        NAMED(V) a[9], q[4];
        for (std::size_t l = 0; l < WIDTH; ++l) {
            for (std::size_t k = 0; k < 9; ++k) a[k][l] = static_cast<REAL>(matrix[k * lanes + half + l]);
            for (std::size_t k = 0; k < 4; ++k) q[k][l] = static_cast<REAL>(quaternion[k * lanes + half + l]);
        }
        NAMED(polar)(a, q);
        for (std::size_t l = 0; l < WIDTH; ++l)
            for (std::size_t k = 0; k < 4; ++k) quaternion[k * lanes + half + l] = static_cast<double>(q[k][l]);
    }
}
