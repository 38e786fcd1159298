#include "catheter/wall_limit.h"

#include <algorithm>
#include <cmath>

#include "core/check.h"
#include "core/units.h"

namespace cathlab {
namespace {

constexpr double still_mm = 1e-12;  // a sample that moves in by less than this does not move

// The point of `shape` at the same place of the material as point `index` of a shape with `size` points; null if none.
const Vec3* partner(std::span<const Vec3> shape, std::size_t size, std::size_t index) {
    const std::size_t behind_tip = size - 1 - index;
    return behind_tip < shape.size() ? &shape[shape.size() - 1 - behind_tip] : nullptr;
}

bool axis_moves(const CatheterState& from, const CatheterState& to, std::size_t axis, std::size_t segments) {
    if (axis < segments)
        return from.bend_rad[axis] != to.bend_rad[axis] || from.direction_rad[axis] != to.direction_rad[axis];
    if (axis == segments) return from.rotation_rad != to.rotation_rad;
    return from.insertion_mm != to.insertion_mm;
}

double& axis_fraction(CatheterFraction& fraction, std::size_t axis) {
    if (axis < fraction.bend.size()) return fraction.bend[axis];
    return axis == fraction.bend.size() ? fraction.rotate : fraction.advance;
}

}  // namespace

double allowed_fraction(std::span<const Vec3> start, std::span<const Vec3> accepted, std::span<const Vec3> attempted,
                        std::span<const WallLimit> limits) {
    double fraction = 1.0;
    for (const WallLimit& limit : limits) {
        const auto i = static_cast<std::size_t>(limit.point);
        CATHLAB_CHECK(i < start.size(), "a limit belongs to a sample of the start pose");
        const Vec3* before = partner(accepted, start.size(), i);
        const Vec3* after = partner(attempted, start.size(), i);
        if (!before || !after) continue;
        const double motion = limit.normal.dot(*after - *before);
        if (motion >= -still_mm) continue;
        const double gap = limit.gap + limit.normal.dot(*before - start[i]);
        const double floor = limit.force >= limit.force_limit ? limit.gap : -limit.penetration_limit;
        fraction = std::min(fraction, std::max(0.0, gap - floor) / -motion);
    }
    return fraction;
}

double allowed_fraction(std::span<const Vec3> previous, std::span<const Vec3> attempted,
                        std::span<const WallLimit> limits) {
    return allowed_fraction(previous, previous, attempted, limits);
}

CatheterTaken take(const CatheterSpec& spec, const CatheterState& state, const CatheterCommand& command,
                   const Rail& rail, std::span<const WallLimit> wall, double h, double insertion_limit_mm) {
    const std::size_t segments = spec.segments.size();
    const auto tried = [&](const CatheterFraction& fraction) {
        return attempt(spec, state, command, fraction, h, insertion_limit_mm);
    };
    CatheterTaken taken;
    taken.fraction = CatheterFraction::all(spec, 1.0);
    const CatheterState full = tried(taken.fraction);
    taken.state = full;
    taken.shape = shape(spec, full, rail);
    if (wall.empty()) return taken;
    std::vector<WallLimit> limits(wall.begin(), wall.end());
    for (WallLimit& limit : limits) limit.penetration_limit *= predicted_share;

    const CatheterShape start = shape(spec, state, rail);
    const double common = allowed_fraction(start.points, taken.shape.points, limits);
    if (common >= 1.0) return taken;

    taken.fraction = CatheterFraction::all(spec, common);
    CatheterShape accepted = shape(spec, tried(taken.fraction), rail);
    for (std::size_t axis = 0; axis < segments + 2; ++axis) {
        if (!axis_moves(state, full, axis, segments)) {
            axis_fraction(taken.fraction, axis) = 1.0;
            continue;
        }
        CatheterFraction whole = taken.fraction;
        axis_fraction(whole, axis) = 1.0;
        const CatheterShape wanted = shape(spec, tried(whole), rail);
        const double part = allowed_fraction(start.points, accepted.points, wanted.points, limits);
        if (part > 0.0) {
            axis_fraction(taken.fraction, axis) = part >= 1.0 ? 1.0 : common + part * (1.0 - common);
            accepted = part >= 1.0 ? wanted : shape(spec, tried(taken.fraction), rail);
        }
        taken.refused = std::max(taken.refused, 1.0 - axis_fraction(taken.fraction, axis));
    }
    taken.state = tried(taken.fraction);
    taken.shape = std::move(accepted);
    taken.refused_advance_mm = full.insertion_mm - taken.state.insertion_mm;
    return taken;
}

}  // namespace cathlab
