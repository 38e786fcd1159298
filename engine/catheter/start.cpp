#include "catheter/start.h"

#include <algorithm>
#include <cmath>

#include "core/deterministic_math.h"
#include "core/units.h"

namespace cathlab {
namespace {

constexpr int rounds = 20;
constexpr double small_turn_rad = 1e-4;
constexpr double damping = 1e-3;  // of the diagonal: arcs that a guidewire leads have nothing to say
constexpr double spacing_mm = 5.0;

void set_bends(const CatheterSpec& spec, const Eigen::VectorXd& bends, CatheterState& state) {
    for (std::size_t k = 0; k < spec.segments.size(); ++k) {
        const auto i = static_cast<Eigen::Index>(2 * k);
        const double bend = std::sqrt(bends[i] * bends[i] + bends[i + 1] * bends[i + 1]);
        state.bend_rad[k] = std::min(bend, spec.segments[k].max_bend_deg * units::deg);
        state.direction_rad[k] = bend > 0.0 ? det::atan2(bends[i + 1], bends[i]) : 0.0;
    }
}

Eigen::VectorXd off_the_rail(const CatheterSpec& spec, const CatheterState& state, const Rail& rail) {
    const CatheterShape lies = shape(spec, state, rail, spacing_mm);
    std::vector<double> off;
    for (std::size_t i = 0; i < lies.points.size(); ++i) {
        if (lies.arc[i] < base_arc_mm(spec, state)) continue;
        const Vec3 d = lies.points[i] - rail.point(lies.arc[i]);
        off.insert(off.end(), {d.x(), d.y(), d.z()});
    }
    return Eigen::Map<const Eigen::VectorXd>(off.data(), static_cast<Eigen::Index>(off.size()));
}

}  // namespace

void lie_along(const CatheterSpec& spec, CatheterState& state, const Rail& rail) {
    const auto unknowns = static_cast<Eigen::Index>(2 * spec.segments.size());
    Eigen::VectorXd bends = Eigen::VectorXd::Zero(unknowns);
    set_bends(spec, bends, state);
    Eigen::VectorXd off = off_the_rail(spec, state, rail);
    for (int round = 0; round < rounds; ++round) {
        Eigen::MatrixXd slope(off.size(), unknowns);
        for (Eigen::Index i = 0; i < unknowns; ++i) {
            Eigen::VectorXd moved = bends;
            moved[i] += small_turn_rad;
            set_bends(spec, moved, state);
            slope.col(i) = (off_the_rail(spec, state, rail) - off) / small_turn_rad;
        }
        Eigen::MatrixXd normal = slope.transpose() * slope;
        normal.diagonal().array() += damping * normal.diagonal().maxCoeff() + 1e-12;
        const Eigen::VectorXd step = normal.ldlt().solve(slope.transpose() * off);
        double share = 1.0;
        for (; share > 1e-3; share *= 0.5) {
            const Eigen::VectorXd tried = bends - share * step;
            set_bends(spec, tried, state);
            const Eigen::VectorXd now = off_the_rail(spec, state, rail);
            if (now.squaredNorm() >= off.squaredNorm()) continue;
            bends = tried;
            off = now;
            break;
        }
        if (share <= 1e-3) break;
    }
    set_bends(spec, bends, state);
}

}  // namespace cathlab
