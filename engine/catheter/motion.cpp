#include "catheter/motion.h"

#include <algorithm>
#include <cmath>

#include "core/check.h"
#include "core/deterministic_math.h"
#include "core/units.h"

namespace cathlab {
namespace {

double finite_or_zero(double x) {
    return std::isfinite(x) ? x : 0.0;
}

double wrapped(double angle) {
    const double turns = std::floor((angle + units::pi) / (2.0 * units::pi));
    const double out = angle - 2.0 * units::pi * turns;
    return out == -units::pi ? units::pi : out;
}

struct Bend {
    double angle, direction;
};

// Straight from `now` towards `target` in the bend plane, by at most `reach`, scaled by `fraction`.
Bend moved(const Bend& now, const Bend& target, double reach, double fraction) {
    const Vec2 from = now.angle * Vec2(det::cos(now.direction), det::sin(now.direction));
    const Vec2 to = target.angle * Vec2(det::cos(target.direction), det::sin(target.direction));
    const double distance = std::sqrt((to - from).squaredNorm());
    if (distance < 1e-12) {
        // Nowhere to go; only a straight segment may take a new direction, which moves nothing.
        return {now.angle, now.angle < 1e-12 && target.angle < 1e-12 ? wrapped(target.direction) : now.direction};
    }
    const double part = fraction * std::min(1.0, reach / distance);
    if (part >= 1.0) return {target.angle, wrapped(target.direction)};
    const Vec2 next = from + part * (to - from);
    const double angle = std::sqrt(next.squaredNorm());
    if (angle < 1e-12) return {0.0, wrapped(target.direction)};
    return {angle, det::atan2(next.y(), next.x())};
}

}  // namespace

void visit(Archive& archive, CatheterState& state) {
    archive.field("insertion_mm", state.insertion_mm);
    archive.field("rotation_rad", state.rotation_rad);
    archive.field("bend_rad", state.bend_rad);
    archive.field("direction_rad", state.direction_rad);
    if (!state.taper.empty()) archive.field("taper", state.taper);
    archive.field("route", state.route);
}

CatheterState initial_state(const CatheterSpec& spec, double insertion_mm) {
    CatheterState state;
    state.insertion_mm = insertion_mm;
    state.bend_rad.assign(spec.segments.size(), 0.0);
    state.direction_rad.assign(spec.segments.size(), 0.0);
    return state;
}

CatheterFraction CatheterFraction::all(const CatheterSpec& spec, double fraction) {
    return {fraction, fraction, std::vector<double>(spec.segments.size(), fraction)};
}

CatheterState attempt(const CatheterSpec& spec, const CatheterState& state, const CatheterCommand& command,
                      const CatheterFraction& fraction, double h, double insertion_limit_mm) {
    const std::size_t count = spec.segments.size();
    CATHLAB_CHECK(state.bend_rad.size() == count && state.direction_rad.size() == count, "state of another catheter");
    CATHLAB_CHECK(command.bend_rad.empty() || command.bend_rad.size() == count, "one bend a segment");
    CATHLAB_CHECK(command.direction_rad.size() == command.bend_rad.size(), "one direction a bend");
    CATHLAB_CHECK(fraction.bend.empty() || fraction.bend.size() == count, "one fraction a segment");

    CatheterState next = state;
    const double longest = spec.max_speed_mm_s * h;
    const double advance = fraction.advance * std::clamp(finite_or_zero(command.advance_mm), -longest, longest);
    const double limit = std::max(state.insertion_mm, std::min(spec.length_mm, insertion_limit_mm));
    next.insertion_mm = std::clamp(state.insertion_mm + advance, 0.0, limit);

    const double widest = spec.max_rotation_deg_s * units::deg * h;
    next.rotation_rad += fraction.rotate * std::clamp(finite_or_zero(command.rotate_rad), -widest, widest);

    for (std::size_t i = 0; i < command.bend_rad.size(); ++i) {
        const CatheterSegment& segment = spec.segments[i];
        if (!std::isfinite(command.bend_rad[i]) || !std::isfinite(command.direction_rad[i])) continue;
        const Bend target{std::clamp(command.bend_rad[i], 0.0, segment.max_bend_deg * units::deg),
                          command.direction_rad[i]};
        const Bend taken =
            moved({state.bend_rad[i], state.direction_rad[i]}, target, segment.max_rate_deg_s * units::deg * h,
                  fraction.bend.empty() ? 1.0 : fraction.bend[i]);
        next.bend_rad[i] = taken.angle;
        next.direction_rad[i] = taken.direction;
    }
    return next;
}

CatheterState attempt(const CatheterSpec& spec, const CatheterState& state, const CatheterCommand& command,
                      double fraction, double h, double insertion_limit_mm) {
    return attempt(spec, state, command, CatheterFraction::all(spec, fraction), h, insertion_limit_mm);
}

}  // namespace cathlab
