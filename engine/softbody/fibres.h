// Collagen fibres in the plane of the wall: two families at +-angle to the vessel's circumference, each spread about
// its direction.  They are slack in compression and stiffen as they are stretched (Gasser, Ogden and Holzapfel's law
// [gasser2006] for fibres that stay in the plane).  With C the right Cauchy-Green tensor of the membrane,
//     H = kappa 1 + (1 - 2 kappa) a a^T,     E = H : C - 1 - onset,
//     W = k1 / (2 k2) (exp(k2 E^2) - 1) where E > 0, else 0,     S = 2 dW/dC = 2 W'(E) H     for each family.
// One law: the solver's loops, the statics and the closed forms of the rigs take it from here.
#pragma once

#include <cmath>

#include "core/deterministic_math.h"
#include "core/units.h"

namespace cathlab {

struct Fibres {
    double stiffness_kpa = 0.0;  ///< k1 of each family, >= 0; 0 = no fibres
    double exponent = 1.0;       ///< k2, >= 0; 0 = a straight line
    double angle_deg = 0.0;      ///< from the circumference, 0 to 90
    double dispersion = 0.0;     ///< kappa: 0 = all along a, 1/2 = every direction of the plane alike
    double onset = 0.0;          ///< E at which the crimp is pulled out, >= 0

    bool any() const { return stiffness_kpa > 0.0; }
    /// Of H = 1/2 + cosine (..) + sine (..) in a frame whose first axis is the circumference.
    double cosine() const { return (0.5 - dispersion) * det::cos(2.0 * angle_deg * units::deg); }
    double sine() const { return (0.5 - dispersion) * det::sin(2.0 * angle_deg * units::deg); }
};

/// Where k2 E^2 reaches this the law goes on as a straight line: exp(4) has made the fibres 500 times as stiff, walls
/// tear before, and a solver must not meet infinity.
inline constexpr double fibre_exponent_limit = 4.0;

/// W'(E), kPa, and its slope W''(E).
struct FibreTension {
    double tension = 0.0, slope = 0.0;
};

inline FibreTension fibre_tension(const Fibres& f, double e) {
    if (!(e > 0.0)) return {};
    const double limit = std::sqrt(fibre_exponent_limit / f.exponent), held = e < limit ? e : limit;
    const double grown = f.stiffness_kpa * det::exp(f.exponent * held * held);
    const double slope = grown * (1.0 + 2.0 * f.exponent * held * held);
    return {grown * held + slope * (e - held), slope};
}

/// W(E), kPa.
inline double fibre_energy(const Fibres& f, double e) {
    if (!(e > 0.0)) return 0.0;
    const double limit = std::sqrt(fibre_exponent_limit / f.exponent), held = e < limit ? e : limit;
    const FibreTension at = fibre_tension(f, held);
    const double beyond = e - held;
    constexpr double straight = 1e-9;
    return (f.exponent > straight ? f.stiffness_kpa / (2.0 * f.exponent) * (det::exp(f.exponent * held * held) - 1.0)
                                  : 0.5 * f.stiffness_kpa * held * held) +
           beyond * (at.tension + 0.5 * at.slope * beyond);
}

}  // namespace cathlab
