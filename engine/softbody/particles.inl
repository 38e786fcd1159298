// The walks over all particles, included once an instruction set, as gather.inl is.  BLOCK particles are three vectors as they
// lie in memory; a number of a particle is spread over its three places there.
using Mask = std::int64_t __attribute__((vector_size(BLOCK * sizeof(std::int64_t))));

// `count` is BLOCK but for the last block, whose empty lanes are 0.
#define BLOCK_INLINE TARGET static inline __attribute__((always_inline))
BLOCK_INLINE Block few(const double* from, std::size_t i, std::size_t count) {
    Block to = {};
    __builtin_memcpy(&to, from + i, count * sizeof(double));
    return to;
}
BLOCK_INLINE void places_of(const double* from, std::size_t i, std::size_t count, Block (&to)[3]) {
    const double* at = from + 3 * i;
    if (count == BLOCK) {  // vector by vector: as one piece they would go through memory
        for (int k = 0; k < 3; ++k) __builtin_memcpy(&to[k], at + k * BLOCK, sizeof to[k]);
    } else {
        to[0] = to[1] = to[2] = Block{};
        __builtin_memcpy(to, at, 3 * count * sizeof(double));
    }
}
BLOCK_INLINE void put(const Block (&from)[3], double* to, std::size_t i, std::size_t count) {
    double* at = to + 3 * i;
    if (count == BLOCK)
        for (int k = 0; k < 3; ++k) __builtin_memcpy(at + k * BLOCK, &from[k], sizeof from[k]);
    else
        __builtin_memcpy(at, from, 3 * count * sizeof(double));
}
#if BLOCK == 2
#define SPREAD(s, to)                             \
    to[0] = __builtin_shufflevector(s, s, 0, 0),  \
    to[1] = s,                                    \
    to[2] = __builtin_shufflevector(s, s, 1, 1)
#else
#define SPREAD(s, to)                                    \
    to[0] = __builtin_shufflevector(s, s, 0, 0, 0, 1),   \
    to[1] = __builtin_shufflevector(s, s, 1, 1, 2, 2),   \
    to[2] = __builtin_shufflevector(s, s, 2, 3, 3, 3)
#endif

// All bits set where a particle is fixed.
BLOCK_INLINE void fixed_places(const std::uint8_t* fixed, std::size_t i, std::size_t count, Mask (&to)[3]) {
    using Bytes = std::uint8_t __attribute__((vector_size(BLOCK)));
    Bytes is = {};
    __builtin_memcpy(&is, fixed + i, count);
    const Mask mask = -__builtin_convertvector(is, Mask);
    SPREAD(mask, to);
}

BLOCK_INLINE Block stiffness_of(const Particles& p, std::size_t i, std::size_t count) {
    const Block k = few(p.stiffness, i, count);
    return p.stiffness_scale ? few(p.stiffness_scale, i, count) * k : k;
}

BLOCK_INLINE void predict_block(const Particles& p, std::size_t i, std::size_t count) {
    const double per_h = 1.0 / p.h, per_h2 = per_h / p.h;
    Block x[3], v[3], stand[3], moved[3], wide[3];
    Mask fixed[3];
    places_of(p.x, i, count, x);
    places_of(p.v, i, count, v);
    places_of(p.rest, i, count, stand);
    fixed_places(p.fixed, i, count, fixed);
    put(x, p.start, i, count);
    if (p.support_before) {
        places_of(p.support_before, i, count, moved);
        for (int k = 0; k < 3; ++k) stand[k] = stand[k] + (1.0 - p.support_share) * moved[k];
        places_of(p.support_after, i, count, moved);
        for (int k = 0; k < 3; ++k) stand[k] = stand[k] + p.support_share * moved[k];
    }
    const Block inertia = few(p.mass, i, count) * per_h2, share = 1.0 / inertia;
    Block around = {}, predicted[3], coasted[3];
    for (int k = 0; k < 3; ++k) predicted[k] = coasted[k] = x[k] + p.h * v[k];
    // The foundation's springs and dashpots are as implicit as the goals; they go into the right-hand side with x~.
    if (p.support) {
        const Block spring = few(p.support, i, count), part = spring * share;
        around += spring;
        SPREAD(part, wide);
        for (int k = 0; k < 3; ++k) predicted[k] += wide[k] * stand[k];
    }
    if (p.drag) {
        const Block dashpot = few(p.drag, i, count) * per_h, part = dashpot * share;
        around += dashpot;
        SPREAD(part, wide);
        for (int k = 0; k < 3; ++k) predicted[k] += wide[k] * x[k];
    }
    for (int k = 0; k < 3; ++k) {
        predicted[k] = fixed[k] ? (p.support_before ? stand[k] : x[k]) : predicted[k];
        coasted[k] = fixed[k] ? predicted[k] : coasted[k];
    }
    put(predicted, p.predicted, i, count);
    put(coasted, p.x, i, count);
    const Block compliance = 1.0 / (inertia + around + stiffness_of(p, i, count));
    for (std::size_t l = 0; l < count; ++l) p.compliance[i + l] = p.fixed[i + l] ? 0.0 : compliance[l];
    const Block none[3] = {};
    put(none, p.force, i, count);
}

BLOCK_INLINE void apply_block(const Particles& p, std::size_t i, std::size_t count) {
    const double per_h2 = 1.0 / p.h / p.h;
    Block x[3], start[3], predicted[3], goal[3], force[3], inertia[3], stiff[3], compliance[3];
    Mask fixed[3];
    places_of(p.x, i, count, x);
    places_of(p.start, i, count, start);
    places_of(p.predicted, i, count, predicted);
    places_of(p.goal, i, count, goal);
    places_of(p.force, i, count, force);
    fixed_places(p.fixed, i, count, fixed);
    const Block m = few(p.mass, i, count) * per_h2, k = stiffness_of(p, i, count), c = few(p.compliance, i, count);
    SPREAD(m, inertia);
    SPREAD(k, stiff);
    SPREAD(c, compliance);
    // No coordinate beyond this, no way beyond p.farthest.
    const double surely = 0.57 * p.farthest;
    Mask far = {};
    for (int j = 0; j < 3; ++j) {
        const Block to = compliance[j] * (inertia[j] * predicted[j] + stiff[j] * goal[j] + force[j]);
        x[j] = fixed[j] ? x[j] : to;
        const Block way = x[j] - start[j];
        far |= (way > surely) | (way < -surely);
    }
    put(x, p.x, i, count);
    std::int64_t any = 0;
    for (int l = 0; l < BLOCK; ++l) any |= far[l];
    if (any == 0) return;
    for (std::size_t l = i; l < i + count; ++l)
        if (!p.fixed[l]) limit_way(p.start + 3 * l, p.farthest, p.x + 3 * l);
}

BLOCK_INLINE void finish_block(const Particles& p, std::size_t i, std::size_t count) {
    Block x[3], start[3], goal[3], last[3], v[3];
    Mask fixed[3];
    places_of(p.x, i, count, x);
    places_of(p.start, i, count, start);
    for (int k = 0; k < 3; ++k) v[k] = (x[k] - start[k]) / p.h;
    if (p.goal) {
        places_of(p.goal, i, count, goal);
        places_of(p.last_goal, i, count, last);
        fixed_places(p.fixed, i, count, fixed);
        for (int k = 0; k < 3; ++k)
            v[k] = fixed[k] ? v[k] : v[k] + p.towards_goal * ((goal[k] - last[k]) / p.h - v[k]);
    }
    put(v, p.v, i, count);
}

#define WALK(name, block)                                                                    \
    TARGET static void name(const Particles& p, std::size_t begin, std::size_t end) {        \
        std::size_t i = begin;                                                               \
        for (; i + BLOCK <= end; i += BLOCK) block(p, i, BLOCK);                             \
        if (i < end) block(p, i, end - i);                                                   \
    }
WALK(predict_particles, predict_block)
WALK(apply_particles, apply_block)
WALK(finish_particles, finish_block)
#undef WALK
#undef SPREAD
#undef BLOCK_INLINE
