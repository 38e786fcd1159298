#include "softbody/uniaxial.h"

#include <algorithm>
#include <cmath>

namespace cathlab {
namespace {

/// The zero of a function that rises, between two places (the Illinois way of the false position); false where it has
/// none there.
template <class F>
bool rising_zero(const F& f, double low, double high, double enough, double& zero) {
    constexpr int most_rounds = 100;
    double at_low = f(low), at_high = f(high);
    if (!(at_low <= 0.0 && at_high >= 0.0)) return false;
    int side = 0;
    for (int round = 0; round < most_rounds; ++round) {
        zero = at_high > at_low ? (low * at_high - high * at_low) / (at_high - at_low) : 0.5 * (low + high);
        const double here = f(zero);
        if (std::fabs(here) < enough || high - low < 1e-13) return true;
        if (here < 0.0) {
            low = zero;
            at_low = here;
            if (side == -1) at_high *= 0.5;
            side = -1;
        } else {
            high = zero;
            at_high = here;
            if (side == 1) at_low *= 0.5;
            side = 1;
        }
    }
    return false;
}

}  // namespace

bool uniaxial_rest(const std::function<void(MembranePoint&)>& law, double stiffness_kpa, double stress_kpa,
                   Uniaxial& from) {
    constexpr int most_rounds = 25, anew_after = 6;
    constexpr double small = 1e-7, tolerance = 1e-7, largest_move = 0.1, least = 0.02, most = 20.0;
    const auto force = [&](const Vec2& u) {
        MembranePoint point;
        point.c = Vec3(u.x() * u.x(), u.y() * u.y(), 0.0);
        law(point);
        return Vec2(point.stress[0] * u.x() - stress_kpa, point.stress[1] * u.y());
    };
    const double enough = tolerance * (stiffness_kpa + std::fabs(stress_kpa));
    Vec2 u(from.along, from.across);
    Eigen::Matrix2d slope = from.slope;
    Vec2 f = force(u);
    for (int round = 0; round < most_rounds; ++round) {
        if (!(f.cwiseAbs().sum() < 1e300)) break;
        if (f.cwiseAbs().maxCoeff() < enough) {
            from = {u.x(), u.y(), slope};
            return true;
        }
        if (slope.isZero(0.0) || round >= anew_after) {
            slope.col(0) = (force(u + Vec2(small, 0.0)) - f) / small;
            slope.col(1) = (force(u + Vec2(0.0, small)) - f) / small;
        }
        const double det = slope.determinant();
        if (!(std::fabs(det) > 1e-14 * stiffness_kpa * stiffness_kpa)) {
            if (round >= anew_after) break;
            round = anew_after;
            continue;
        }
        Vec2 move(-(f.x() * slope(1, 1) - slope(0, 1) * f.y()) / det,
                  -(slope(0, 0) * f.y() - f.x() * slope(1, 0)) / det);
        // By so much of themselves at most: the law knows nothing of stretches below 0.
        const double far = std::max(std::fabs(move.x()) / u.x(), std::fabs(move.y()) / u.y());
        if (far > largest_move) move *= largest_move / far;
        const Vec2 next(std::clamp(u.x() + move.x(), least, most), std::clamp(u.y() + move.y(), least, most));
        const Vec2 went = next - u, there = force(next);
        const double square = went.squaredNorm();
        if (square > 0.0) slope += (there - f - slope * went) * went.transpose() / square;
        u = next;
        f = there;
    }
    // A law with corners: one stretch within the other, both forces rise with theirs.
    double across = 1.0;
    const auto along_force = [&](double along) {
        const double middle = 1.0 / std::sqrt(along);
        const auto sideways = [&](double a) { return force(Vec2(along, a)).y(); };
        if (!rising_zero(sideways, 0.2 * middle, 4.0 * middle, 0.1 * enough, across)) return std::nan("");
        return force(Vec2(along, across)).x();
    };
    double along = 1.0;
    if (!rising_zero(along_force, 0.2, 4.0, enough, along)) return false;
    from = {along, across, Eigen::Matrix2d::Zero()};
    return true;
}

}  // namespace cathlab
