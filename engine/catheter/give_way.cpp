#include "catheter/give_way.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/check.h"
#include "core/deterministic_math.h"
#include "core/units.h"

namespace cathlab {
namespace {

constexpr double small_move_mm = 0.05;
constexpr double small_turn_rad = 0.005;

// Work of the pushes on the way from one shape to the other, samples matched from the tip, mN mm.
double work(std::span<const WallPush> pushes, const CatheterShape& from, const CatheterShape& to) {
    double sum = 0.0;
    for (const WallPush& push : pushes) {
        const std::size_t i = static_cast<std::size_t>(push.point);
        CATHLAB_CHECK(i < from.points.size(), "a push belongs to a sample of the pose");
        const std::size_t behind_tip = from.points.size() - 1 - i;
        if (behind_tip >= to.points.size()) continue;
        sum += push.force.dot(to.points[to.points.size() - 1 - behind_tip] - from.points[i]);
    }
    return sum;
}

Vec2 bend_vector(const CatheterState& state, std::size_t segment) {
    return state.bend_rad[segment] *
           Vec2(det::cos(state.direction_rad[segment]), det::sin(state.direction_rad[segment]));
}

void set_bend(const Vec2& bend, double& angle, double& direction) {
    angle = std::sqrt(bend.squaredNorm());
    if (angle > 1e-12) direction = det::atan2(bend.y(), bend.x());
}

}  // namespace

CatheterCommand give_way(const CatheterSpec& spec, const CatheterState& state, const Rail& rail,
                         const CatheterShape& now, std::span<const WallPush> pushes, double share, double h) {
    const std::size_t segments = spec.segments.size();
    const auto load = [&](const CatheterState& moved, double step) {
        return work(pushes, now, shape(spec, moved, rail)) / step;
    };
    CatheterState moved = state;
    moved.insertion_mm = std::max(0.0, state.insertion_mm - small_move_mm);
    const double back = std::max(0.0, state.insertion_mm > small_move_mm ? load(moved, small_move_mm) : 0.0);
    moved = state;
    moved.rotation_rad += small_turn_rad;
    const double twist = load(moved, small_turn_rad);
    std::vector<Vec2> bend(segments, Vec2::Zero());
    for (std::size_t k = 0; k < segments; ++k)
        for (Index axis = 0; axis < 2; ++axis) {
            moved = state;
            Vec2 vector = bend_vector(state, k);
            vector[axis] += small_turn_rad;
            set_bend(vector, moved.bend_rad[k], moved.direction_rad[k]);
            bend[k][axis] = load(moved, small_turn_rad);
        }

    const double speed = spec.max_speed_mm_s * h, turn = spec.max_rotation_deg_s * units::deg * h;
    const auto rate = [&](std::size_t k) { return spec.segments[k].max_rate_deg_s * units::deg * h; };
    double power = speed * speed * back * back + turn * turn * twist * twist;
    for (std::size_t k = 0; k < segments; ++k) power += rate(k) * rate(k) * bend[k].squaredNorm();
    CatheterCommand command;
    command.bend_rad = state.bend_rad;
    command.direction_rad = state.direction_rad;
    if (!(power > 0.0)) return command;
    const double scale = share / std::sqrt(power);
    command.advance_mm = -scale * speed * speed * back;
    command.rotate_rad = scale * turn * turn * twist;
    for (std::size_t k = 0; k < segments; ++k)
        set_bend(bend_vector(state, k) + scale * rate(k) * rate(k) * bend[k], command.bend_rad[k],
                 command.direction_rad[k]);
    return command;
}

}  // namespace cathlab
