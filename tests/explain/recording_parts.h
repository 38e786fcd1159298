// What the makers of recordings share: matrices, commands, laws in a few lines.
#pragma once

#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <random>
#include <vector>

#include "explain/recording.h"

namespace explain_test {

std::unique_ptr<Folder> record_catheter(const Recipe& r);
std::unique_ptr<Folder> record_tendons(const Recipe& r);
std::unique_ptr<Folder> record_contact(const Recipe& r);

/// Whether an effect acts in a recording; two are written "a+b".
inline bool acts_in(const Recipe& r, const std::string& effect) {
    const auto at = r.effect.find('+');
    return r.effect.substr(0, at) == effect || (at != std::string::npos && r.effect.substr(at + 1) == effect);
}

inline constexpr double pi = std::numbers::pi;
inline constexpr double rad = pi / 180.0;

using V = std::array<double, 3>;
using M = std::array<V, 3>;  // columns

inline M identity() {
    return {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
}
inline V times(const M& m, const V& v) {
    V out{};
    for (int k = 0; k < 3; ++k)
        for (int j = 0; j < 3; ++j) out[k] += m[j][k] * v[j];
    return out;
}
inline M times(const M& a, const M& b) {
    return {times(a, b[0]), times(a, b[1]), times(a, b[2])};
}
inline M about(int axis, double angle) {
    const double c = std::cos(angle), s = std::sin(angle);
    M out = identity();
    const int i = (axis + 1) % 3, j = (axis + 2) % 3;
    out[i][i] = c;
    out[i][j] = s;
    out[j][i] = -s;
    out[j][j] = c;
    return out;
}
inline void go(V& at, const M& frame, double ahead) {
    for (int k = 0; k < 3; ++k) at[k] += ahead * frame[2][k];
}

/// Smooth random commands: a sum of sines with seeded phases, and halts in between.
class Command {
public:
    Command(std::mt19937_64& random, double middle, double reach) : middle_(middle), reach_(reach) {
        std::uniform_real_distribution<double> phase(0.0, 2.0 * pi), period(7.0, 31.0);
        for (int k = 0; k < 3; ++k) parts_.push_back({period(random), phase(random)});
    }
    double operator()(double t) const {
        double sum = 0.0;
        for (const auto& [period, phase] : parts_) sum += std::sin(2.0 * pi * t / period + phase);
        return middle_ + reach_ * sum / 3.0;
    }

private:
    double middle_, reach_;
    std::vector<std::array<double, 2>> parts_;
};

/// Moves only when pushed by either edge of a gap.
inline void through_gap(double gap, double wanted, double& at) {
    if (wanted - at > 0.5 * gap) at = wanted - 0.5 * gap;
    if (at - wanted > 0.5 * gap) at = wanted + 0.5 * gap;
}

inline double breath(double turn) {
    const double s = std::sin(pi * turn);
    return s * s * s * s;
}

/// Readings that go wrong with the square of the distance from the tracker.
inline void distort(double size, V& tip) {
    const double square = (tip[0] * tip[0] + tip[1] * tip[1] + tip[2] * tip[2]) / 1e4;
    tip[0] += 1.2 * size * square;
    tip[1] -= 1.8 * size * square;
    tip[2] += 0.6 * size * square;
}

}  // namespace explain_test
