// The walks over all particles, included once an instruction set, as gather.inl is.  BLOCK particles are three vectors as they
// lie in memory; a number of a particle is spread over its three places there.
using Mask = std::int64_t __attribute__((vector_size(BLOCK * sizeof(std::int64_t))));
// Three members and not an array, which would be kept in memory.
struct Places {
    Block a, b, c;
};
#define EACH(of) of(a) of(b) of(c)

// `count` is BLOCK but for the last block, whose empty lanes are 0.
#define BLOCK_INLINE TARGET static inline __attribute__((always_inline))
BLOCK_INLINE Block few(const double* from, std::size_t i, std::size_t count) {
    Block to = {};
    __builtin_memcpy(&to, from + i, count * sizeof(double));
    return to;
}
BLOCK_INLINE void places_of(const double* from, std::size_t i, std::size_t count, Places& to) {
    const double* at = from + 3 * i;
    if (count == BLOCK) {
        __builtin_memcpy(&to.a, at, sizeof to.a);
        __builtin_memcpy(&to.b, at + BLOCK, sizeof to.b);
        __builtin_memcpy(&to.c, at + std::size_t{2} * BLOCK, sizeof to.c);
    } else {
        to.a = to.b = to.c = Block{};
        __builtin_memcpy(&to, at, 3 * count * sizeof(double));
    }
}
BLOCK_INLINE void put(const Places& from, double* to, std::size_t i, std::size_t count) {
    double* at = to + 3 * i;
    if (count == BLOCK) {
        __builtin_memcpy(at, &from.a, sizeof from.a);
        __builtin_memcpy(at + BLOCK, &from.b, sizeof from.b);
        __builtin_memcpy(at + std::size_t{2} * BLOCK, &from.c, sizeof from.c);
    } else {
        __builtin_memcpy(at, &from, 3 * count * sizeof(double));
    }
}
#if BLOCK == 2
#define SPREAD(s, to)                               \
    (to).a = __builtin_shufflevector(s, s, 0, 0),   \
    (to).b = (s),                                   \
    (to).c = __builtin_shufflevector(s, s, 1, 1)
#else
#define SPREAD(s, to)                                      \
    (to).a = __builtin_shufflevector(s, s, 0, 0, 0, 1),    \
    (to).b = __builtin_shufflevector(s, s, 1, 1, 2, 2),    \
    (to).c = __builtin_shufflevector(s, s, 2, 3, 3, 3)
#endif

struct Fixed {
    Mask a, b, c;
};
// All bits set where a particle is fixed.  Whether any is.
BLOCK_INLINE bool fixed_places(const std::uint8_t* fixed, std::size_t i, std::size_t count, Fixed& to) {
    std::uint32_t any = 0;
    static_assert(sizeof any >= BLOCK);
    __builtin_memcpy(&any, fixed + i, count);
    if (any == 0) return false;
    Mask mask = {};
    for (std::size_t l = 0; l < count; ++l) mask[l] = -static_cast<std::int64_t>(fixed[i + l]);
    SPREAD(mask, to);
    return true;
}

BLOCK_INLINE Block stiffness_of(const Particles& p, std::size_t i, std::size_t count) {
    const Block k = few(p.stiffness, i, count);
    return p.stiffness_scale ? few(p.stiffness_scale, i, count) * k : k;
}

BLOCK_INLINE void predict_block(const Particles& p, double per_h, double per_h2, std::size_t i, std::size_t count) {
    Places x, v, stand, moved, wide;
    places_of(p.x, i, count, x);
    places_of(p.v, i, count, v);
    places_of(p.rest, i, count, stand);
    put(x, p.start, i, count);
    if (p.support_before) {
        const double share = p.support_share, rest = 1.0 - share;
        places_of(p.support_before, i, count, moved);
#define TO(k) stand.k = stand.k + rest * moved.k;
        EACH(TO)
#undef TO
        places_of(p.support_after, i, count, moved);
#define TO(k) stand.k = stand.k + share * moved.k;
        EACH(TO)
#undef TO
    }
    const Block inertia = few(p.mass, i, count) * per_h2, share = 1.0 / inertia;
    Block around = {};
    Places predicted, coasted;
#define TO(k) predicted.k = coasted.k = x.k + p.h * v.k;
    EACH(TO)
#undef TO
    // The foundation's springs and dashpots are as implicit as the goals; they go into the right-hand side with x~.
    if (p.support) {
        const Block spring = few(p.support, i, count), part = spring * share;
        around += spring;
        SPREAD(part, wide);
#define TO(k) predicted.k += wide.k * stand.k;
        EACH(TO)
#undef TO
    }
    if (p.drag) {
        const Block dashpot = few(p.drag, i, count) * per_h, part = dashpot * share;
        around += dashpot;
        SPREAD(part, wide);
#define TO(k) predicted.k += wide.k * x.k;
        EACH(TO)
#undef TO
    }
    Block compliance = 1.0 / (inertia + around + stiffness_of(p, i, count));
    Fixed fixed;
    if (fixed_places(p.fixed, i, count, fixed)) {
        const Places held = p.support_before ? stand : x;
#define TO(k)                                        \
    predicted.k = fixed.k ? held.k : predicted.k;    \
    coasted.k = fixed.k ? predicted.k : coasted.k;
        EACH(TO)
#undef TO
        for (std::size_t l = 0; l < count; ++l) compliance[l] = p.fixed[i + l] ? 0.0 : compliance[l];
    }
    put(predicted, p.predicted, i, count);
    put(coasted, p.x, i, count);
    __builtin_memcpy(p.compliance + i, &compliance, count * sizeof(double));
    const Places none{};
    put(none, p.force, i, count);
}

BLOCK_INLINE void apply_block(const Particles& p, double, double per_h2, std::size_t i, std::size_t count) {
    Places x, start, predicted, goal, force, inertia, stiff, compliance;
    places_of(p.start, i, count, start);
    places_of(p.predicted, i, count, predicted);
    places_of(p.goal, i, count, goal);
    places_of(p.force, i, count, force);
    const Block m = few(p.mass, i, count) * per_h2, s = stiffness_of(p, i, count), c = few(p.compliance, i, count);
    SPREAD(m, inertia);
    SPREAD(s, stiff);
    SPREAD(c, compliance);
#define TO(k) x.k = compliance.k * (inertia.k * predicted.k + stiff.k * goal.k + force.k);
    EACH(TO)
#undef TO
    Fixed fixed;
    if (fixed_places(p.fixed, i, count, fixed)) {
        Places held;
        places_of(p.x, i, count, held);
#define TO(k) x.k = fixed.k ? held.k : x.k;
        EACH(TO)
#undef TO
    }
    put(x, p.x, i, count);
    // No coordinate beyond this, no way beyond p.farthest.
    const double surely = 0.57 * p.farthest;
    Mask far = {};
#define TO(k) far |= (x.k - start.k > surely) | (x.k - start.k < -surely);
    EACH(TO)
#undef TO
    std::int64_t any = 0;
    for (int l = 0; l < BLOCK; ++l) any |= far[l];
    if (any == 0) return;
    for (std::size_t l = i; l < i + count; ++l)
        if (!p.fixed[l]) limit_way(p.start + 3 * l, p.farthest, p.x + 3 * l);
}

BLOCK_INLINE void finish_block(const Particles& p, double, double, std::size_t i, std::size_t count) {
    Places x, start, goal, last, v;
    places_of(p.x, i, count, x);
    places_of(p.start, i, count, start);
#define TO(k) v.k = (x.k - start.k) / p.h;
    EACH(TO)
#undef TO
    if (p.goal) {
        places_of(p.goal, i, count, goal);
        places_of(p.last_goal, i, count, last);
        const Places own = v;
#define TO(k) v.k = v.k + p.towards_goal * ((goal.k - last.k) / p.h - v.k);
        EACH(TO)
#undef TO
        Fixed fixed;
        if (fixed_places(p.fixed, i, count, fixed)) {
#define TO(k) v.k = fixed.k ? own.k : v.k;
            EACH(TO)
#undef TO
        }
    }
    put(v, p.v, i, count);
}

// A copy of what is read in every block: a store to an array could, for all that the compiler knows, change the original.
#define WALK(name, block)                                                                     \
    TARGET static void name(const Particles& given, std::size_t begin, std::size_t end) {     \
        const Particles p = given;                                                            \
        const double per_h = 1.0 / p.h, per_h2 = per_h / p.h;                                 \
        std::size_t i = begin;                                                                \
        for (; i + BLOCK <= end; i += BLOCK) block(p, per_h, per_h2, i, BLOCK);               \
        if (i < end) block(p, per_h, per_h2, i, end - i);                                     \
    }
WALK(predict_particles, predict_block)
WALK(apply_particles, apply_block)
WALK(finish_particles, finish_block)
#undef WALK
#undef SPREAD
#undef BLOCK_INLINE
#undef EACH
