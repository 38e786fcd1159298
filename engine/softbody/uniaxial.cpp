#include "softbody/uniaxial.h"

#include <algorithm>
#include <cmath>

namespace cathlab {

bool uniaxial_rest(const std::function<void(MembranePoint&)>& law, double stiffness_kpa, double stress_kpa,
                   Uniaxial& from) {
    constexpr int most_rounds = 60, anew_after = 6;  // rounds
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
        if (!(f.cwiseAbs().sum() < 1e300)) return false;
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
            if (round >= anew_after) return false;
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
    return false;
}

}  // namespace cathlab
