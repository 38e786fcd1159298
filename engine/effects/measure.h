// In which measure of strain, and of the stress that works on it, a law of the wall is written: Seth and Hill's
// [hill1968],
//     E_m = (C^(m/2) - 1) / m   (m = 0: ln(C) / 2),   S_m = C^((2-m)/4) S C^((2-m)/4).
// m = 2: Green's strain and the second Piola-Kirchhoff stress.  m = 1: Biot's, strain by the length at rest and stress
// by the section at rest, which is what a tensile machine reads.  m = 0: Hencky's.  S_m is exact where stress and
// strain have the same axes.
#pragma once

#include <algorithm>
#include <cmath>

#include "core/deterministic_math.h"
#include "core/types.h"

namespace cathlab {

class StrainMeasure {
public:
    explicit StrainMeasure(double m) : m_(m) {}

    Vec3 strain(const Vec3& c) const {
        if (m_ == 2.0) return {0.5 * (c[0] - 1.0), 0.5 * (c[1] - 1.0), 0.5 * c[2]};
        const bool hencky = std::fabs(m_) < nearly_none;
        return of(c, [&](double l) {
            l = std::max(l, least);
            return hencky ? 0.5 * det::log(l) : (det::pow(l, 0.5 * m_) - 1.0) / m_;
        });
    }
    /// C of a strain.
    Vec3 c(const Vec3& e) const {
        if (m_ == 2.0) return {1.0 + 2.0 * e[0], 1.0 + 2.0 * e[1], 2.0 * e[2]};
        const bool hencky = std::fabs(m_) < nearly_none;
        return of(e, [&](double s) {
            return hencky ? det::exp(2.0 * s) : det::pow(std::max(1.0 + m_ * s, least), 2.0 / m_);
        });
    }
    /// S_m of S, at C.
    Vec3 stress(const Vec3& s, const Vec3& c) const { return between(s, c, 0.25 * (2.0 - m_)); }
    /// S of S_m.
    Vec3 second_piola(const Vec3& s, const Vec3& c) const { return between(s, c, -0.25 * (2.0 - m_)); }

private:
    static constexpr double nearly_none = 1e-3, least = 1e-4;

    /// f of a symmetric tensor (11, 22, 12): a 1 + b A, with b the slope of f between A's two eigenvalues.
    template <class F>
    static Vec3 of(const Vec3& a, const F& f) {
        const double middle = 0.5 * (a[0] + a[1]), half = 0.5 * (a[0] - a[1]);
        const double apart = std::sqrt(half * half + a[2] * a[2]), d = std::max(apart, 1e-6);
        const double high = f(middle + d), low = f(middle - d), slope = (high - low) / (2.0 * d);
        const double mean = 0.5 * (high + low);
        return {mean + slope * half, mean - slope * half, slope * a[2]};
    }

    /// C^power S C^power.
    static Vec3 between(const Vec3& s, const Vec3& c, double power) {
        if (power == 0.0) return s;
        const Vec3 v = of(c, [&](double l) { return det::pow(std::max(l, least), power); });
        const double sv00 = s[0] * v[0] + s[2] * v[2], sv01 = s[0] * v[2] + s[2] * v[1];
        const double sv10 = s[2] * v[0] + s[1] * v[2], sv11 = s[2] * v[2] + s[1] * v[1];
        return {v[0] * sv00 + v[2] * sv10, v[2] * sv01 + v[1] * sv11, v[0] * sv01 + v[2] * sv11};
    }

    double m_;
};

}  // namespace cathlab
