// What beam theory says of a wire of sections, found without the chain: integrals over the compliance, and a fine line
// of angles for bends that are not small.
#pragma once

#include <cmath>
#include <functional>
#include <vector>

#include "rod/wire_spec.h"

namespace cathlab::test {

inline const WireSection& section_at(const WireSpec& spec, double from_tip) {
    double end = 0.0;
    for (const WireSection& s : spec.sections) {
        end += s.length_mm;
        if (from_tip < end) return s;
    }
    return spec.sections.back();
}

/// Sum of f(s) ds / stiffness(s) from `begin` to `end`, mm from the tip, by the midpoint rule.
inline double over_compliance(const WireSpec& spec, double begin, double end, double WireSection::*stiffness,
                              const std::function<double(double)>& f, int pieces = 20000) {
    const double ds = (end - begin) / pieces;
    double sum = 0.0;
    for (int i = 0; i < pieces; ++i) {
        const double s = begin + (i + 0.5) * ds;
        sum += f(s) * ds / (1000.0 * (section_at(spec, s).*stiffness));
    }
    return sum;
}

/// Drop of a cantilever at its load (begin mm behind the tip) for 1 mN across, by Castigliano: sum of lever^2 / EI.
inline double drop_per_mn(const WireSpec& spec, double begin, double insertion) {
    return over_compliance(spec, begin, insertion, &WireSection::bending_stiffness_n_mm2,
                           [&](double s) { return (s - begin) * (s - begin); });
}

/// Where the load's point of a cantilever of length `insertion - begin` comes to stand under the dead load p across:
/// (axial, across), mm.  Least of sum EI/2 (da/ds)^2 ds - p sin(a) ds over the angles a of 1500 pieces, by Newton.
struct Elastica {
    double axial = 0.0, across = 0.0;
};
inline Elastica elastica(const WireSpec& spec, double begin, double insertion, double p) {
    const std::size_t n = 1500;
    const double ds = (insertion - begin) / static_cast<double>(n);
    std::vector<double> k(n + 1), a(n, 0.0), diagonal(n), right(n);  // piece 0 is at the clamp; k[i] is before piece i
    for (std::size_t i = 0; i < n; ++i) {
        const double s = insertion - static_cast<double>(i) * ds;
        k[i] = 1000.0 * section_at(spec, s - 1e-9).bending_stiffness_n_mm2 / ds;
    }
    k[0] *= 2.0;  // the clamp is half a piece away
    k[n] = 0.0;
    for (int ramp = 1; ramp <= 20; ++ramp) {
        const double load = p * ds * ramp / 20.0;
        for (int pass = 0; pass < 8; ++pass) {
            for (std::size_t i = 0; i < n; ++i) {
                const double before = i > 0 ? a[i - 1] : 0.0, after = i + 1 < n ? a[i + 1] : a[i];
                right[i] = load * std::cos(a[i]) - k[i] * (a[i] - before) + k[i + 1] * (after - a[i]);
                diagonal[i] = k[i] + k[i + 1] + load * std::sin(a[i]);
            }
            for (std::size_t i = 1; i < n; ++i) {
                const double factor = k[i] / diagonal[i - 1];
                diagonal[i] -= factor * k[i];
                right[i] += factor * right[i - 1];
            }
            for (std::size_t i = n; i-- > 0;) {
                right[i] = (right[i] + (i + 1 < n ? k[i + 1] * right[i + 1] : 0.0)) / diagonal[i];
                a[i] += right[i];
            }
        }
    }
    Elastica tip;
    for (const double angle : a) {
        tip.axial += ds * std::cos(angle);
        tip.across += ds * std::sin(angle);
    }
    return tip;
}

/// The load across under which the elastica drops by `share` of its length, mN.
inline double load_for_drop(const WireSpec& spec, double begin, double insertion, double share) {
    double low = 0.0, high = share * (insertion - begin) / drop_per_mn(spec, begin, insertion);
    while (elastica(spec, begin, insertion, high).across < share * (insertion - begin)) high *= 2.0;
    for (int i = 0; i < 30; ++i) {
        const double middle = 0.5 * (low + high);
        (elastica(spec, begin, insertion, middle).across < share * (insertion - begin) ? low : high) = middle;
    }
    return 0.5 * (low + high);
}

/// Euler's load of a column of sections, clamped at the mouth and pressed on the point `begin` mm behind its tip, which
/// is free: the least p for which u'' = -p u / EI, u = 0 and u' = 1 at the load, has u' = 0 at the clamp.
inline double euler_load(const WireSpec& spec, double begin, double insertion) {
    const auto slope_at_clamp = [&](double p) {
        const int n = 6000;
        const double ds = (insertion - begin) / n;
        double u = 0.0, slope = 1.0;
        for (int i = 0; i < n && slope > 0.0; ++i) {
            const double ei = 1000.0 * section_at(spec, begin + (i + 0.5) * ds).bending_stiffness_n_mm2;
            const double middle = u + 0.5 * ds * slope;
            slope -= ds * p * middle / ei;
            u = middle + 0.5 * ds * slope;
        }
        return slope;
    };
    double low = 0.0, high = 1e-3;
    while (slope_at_clamp(high) > 0.0) high *= 2.0;
    for (int i = 0; i < 50; ++i) (slope_at_clamp(0.5 * (low + high)) > 0.0 ? low : high) = 0.5 * (low + high);
    return 0.5 * (low + high);
}

}  // namespace cathlab::test
