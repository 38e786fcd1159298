#include "machine_floor.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstring>

#include "softbody/kernel.h"

namespace cathlab {

namespace {

using Clock = std::chrono::steady_clock;

// Twelve chains keep two multipliers and two adders of three or four cycles' latency busy, and leave registers for a
// and b.
constexpr std::size_t chains = 12;

// x tends to b / (1 - a), of order 1: no number becomes so small that the processor slows down.
struct Constants {
    double a = 0.875, b = 0.125, start[chains];

    Constants() {
        for (std::size_t k = 0; k < chains; ++k) start[k] = 0.5 + 0.01 * static_cast<double>(k);
    }
};

// The sums alternate their sign, so that they stay in range too.
// NOLINTBEGIN(bugprone-macro-parentheses): types and attributes
#define CATHLAB_LOOPS(SET, TARGET, BYTES, REAL, PAIR)                                           \
    TARGET void pairs_##SET##_##REAL(std::size_t rounds, const Constants& with, double* out) {  \
        using V = REAL __attribute__((vector_size(BYTES)));                                     \
        const V a = V{} + static_cast<REAL>(with.a), b = V{} + static_cast<REAL>(with.b);       \
        V x[chains];                                                                            \
        for (std::size_t k = 0; k < chains; ++k) x[k] = V{} + static_cast<REAL>(with.start[k]); \
        for (std::size_t k = 0; k < rounds; ++k)                                                \
            for (auto& v : x) v = PAIR(v, a, b);                                                \
        for (const auto& v : x) *out += static_cast<double>(v[0]);                              \
    }                                                                                           \
    TARGET void sums_##SET##_##REAL(std::size_t rounds, const Constants& with, double* out) {   \
        using V = REAL __attribute__((vector_size(BYTES)));                                     \
        const V b = V{} + static_cast<REAL>(with.b);                                            \
        V x[chains];                                                                            \
        for (std::size_t k = 0; k < chains; ++k) x[k] = V{} + static_cast<REAL>(with.start[k]); \
        for (std::size_t k = 0; k < rounds; k += 2) {                                           \
            for (auto& v : x) v = v + b;                                                        \
            for (auto& v : x) v = v - b;                                                        \
        }                                                                                       \
        for (const auto& v : x) *out += static_cast<double>(v[0]);                              \
    }

#define CATHLAB_APART(x, a, b) ((x) * (a) + (b))
CATHLAB_LOOPS(plain, , 16, float, CATHLAB_APART)
CATHLAB_LOOPS(plain, , 16, double, CATHLAB_APART)
#if defined(__x86_64__)
// A product and a sum in one where the kernels have them so: in float.
CATHLAB_LOOPS(wide, __attribute__((target("avx2,fma"))), 32, float, __builtin_ia32_vfmaddps256)
CATHLAB_LOOPS(wide, __attribute__((target("avx2,fma"))), 32, double, CATHLAB_APART)
#else
CATHLAB_LOOPS(wide, , 16, float, CATHLAB_APART)
CATHLAB_LOOPS(wide, , 16, double, CATHLAB_APART)
#endif
#undef CATHLAB_APART
#undef CATHLAB_LOOPS
// NOLINTEND(bugprone-macro-parentheses)

// Seen from outside, so that no loop can be left out.
volatile double nobody_knows = 1.0;

using Loop = void (*)(std::size_t, const Constants&, double*);

void run(Loop loop, double operations, std::size_t lanes, const Constants& with, double* out) {
    loop(static_cast<std::size_t>(std::llround(operations / static_cast<double>(lanes * chains))), with, out);
}

}  // namespace

double arithmetic_ms(const Arithmetic& work) {
    const bool wide = kernel::avx2() != nullptr;
    const std::size_t lanes = wide ? 4 : 2;  // of double
    Constants with;
    with.a *= nobody_knows;
    double out = 0.0;
    const auto paired = [](const Operations& of) { return std::min(of.products, of.sums); };
    const auto alone = [](const Operations& of) { return std::abs(of.products - of.sums); };
    const auto begin = Clock::now();
    run(wide ? pairs_wide_float : pairs_plain_float, paired(work.in_float), 2 * lanes, with, &out);
    run(wide ? sums_wide_float : sums_plain_float, alone(work.in_float), 2 * lanes, with, &out);
    run(wide ? pairs_wide_double : pairs_plain_double, paired(work.in_double), lanes, with, &out);
    run(wide ? sums_wide_double : sums_plain_double, alone(work.in_double), lanes, with, &out);
    const auto end = Clock::now();
    nobody_knows = out != 0.0 ? 1.0 : 0.0;
    return std::chrono::duration<double, std::milli>(end - begin).count();
}

CopyTimer::CopyTimer(std::size_t bytes) : from_(bytes / 2, 1), to_(bytes / 2, 0) {}

double CopyTimer::ms() {
    const auto begin = Clock::now();
    std::memcpy(to_.data(), from_.data(), from_.size());
    const auto end = Clock::now();
    from_.front() = static_cast<unsigned char>(to_.back() + 1);
    return std::chrono::duration<double, std::milli>(end - begin).count();
}

}  // namespace cathlab
