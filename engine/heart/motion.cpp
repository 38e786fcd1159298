#include "heart/motion.h"

#include <array>
#include <cmath>
#include <sstream>

#include "core/deterministic_math.h"
#include "core/range.h"

namespace cathlab {
namespace {

[[noreturn]] void wrong(const SourcePlace& where, const std::string& key, double found, const std::string& allowed) {
    SourcePlace place = where;
    place.key = key;
    std::ostringstream text;
    text << "found " << found << ", allowed is " << allowed;
    throw UserError(place, text.str());
}

double wrap(double phase) {
    const double out = phase - std::floor(phase);
    return out < 1.0 ? out : 0.0;
}

}  // namespace

std::vector<HeartKnot> HeartSpec::default_knots(double excursion_mm) {
    // (phase, share of the excursion): descent in systole, isovolumic rest, early filling, diastasis, atrial kick.
    constexpr std::array<std::array<double, 2>, 10> shape = {{{0.00, 1.00},
                                                              {0.06, 0.97},
                                                              {0.25, 0.38},
                                                              {0.40, 0.03},
                                                              {0.45, 0.00},
                                                              {0.53, 0.04},
                                                              {0.66, 0.62},
                                                              {0.78, 0.71},
                                                              {0.87, 0.75},
                                                              {0.96, 0.98}}};
    std::vector<HeartKnot> knots;
    knots.reserve(shape.size());
    for (const auto& [phase, share] : shape) knots.push_back({phase, share * excursion_mm});
    return knots;
}

void validate(const HeartSpec& spec, const SourcePlace& where) {
    require_range(where, "rate_bpm", spec.rate_bpm, 20.0, 250.0);
    require_range(where, "radius_mm", spec.radius_mm, 1.0, 60.0);
    require_range(where, "height_mm", spec.height_mm, 1.0, 200.0);
    require_range(where, "rest_gap_mm", spec.rest_gap_mm, 0.0, 50.0);
    require_range(where, "initial_phase", spec.initial_phase, 0.0, 1.0);
    if (!spec.tilt_rad.allFinite()) wrong(where, "tilt_rad", spec.tilt_rad.sum(), "three finite numbers");
    if (spec.knots.size() < 2) wrong(where, "knots", static_cast<double>(spec.knots.size()), "two knots or more");
    double before = -1.0;
    for (const HeartKnot& knot : spec.knots) {
        if (!(knot.phase >= 0.0 && knot.phase < 1.0 && knot.phase > before))
            wrong(where, "knots: phase", knot.phase, "increasing from knot to knot, from 0 to below 1");
        require_range(where, "knots: displacement_mm", knot.displacement_mm, -30.0, 30.0);
        before = knot.phase;
    }
}

void visit(Archive& archive, HeartState& state) {
    archive.field("phase", state.phase);
    archive.field("displacement_mm", state.displacement_mm);
    archive.field("velocity_mm_s", state.velocity_mm_s);
    archive.field("beats", state.beats);
}

ProfileValue profile(const HeartSpec& spec, double phase) {
    const std::vector<HeartKnot>& knots = spec.knots;
    const std::size_t n = knots.size();
    const double at = wrap(phase);
    std::size_t i = n - 1;  // the last knot's interval runs over the end of the beat to the first
    for (std::size_t k = 0; k + 1 < n; ++k)
        if (at >= knots[k].phase && at < knots[k + 1].phase) i = k;

    const auto width = [&](std::size_t k) {  // of the interval that begins at knot k
        return k + 1 < n ? knots[k + 1].phase - knots[k].phase : knots[0].phase + 1.0 - knots[k].phase;
    };
    const auto secant = [&](std::size_t k) {
        return (knots[(k + 1) % n].displacement_mm - knots[k].displacement_mm) / width(k);
    };
    // Slope at a knot: weighted harmonic mean of the secants beside it, 0 at an extremum.
    const auto slope = [&](std::size_t k) {
        const std::size_t before = (k + n - 1) % n;
        const double s0 = secant(before), s1 = secant(k), h0 = width(before), h1 = width(k);
        if (s0 * s1 <= 0.0) return 0.0;
        return 3.0 * (h0 + h1) / ((2.0 * h1 + h0) / s0 + (h1 + 2.0 * h0) / s1);
    };
    const double h = width(i);
    const double t = (at >= knots[i].phase ? at - knots[i].phase : at + 1.0 - knots[i].phase) / h;
    const double y0 = knots[i].displacement_mm, y1 = knots[(i + 1) % n].displacement_mm;
    const double m0 = h * slope(i), m1 = h * slope((i + 1) % n);
    const double t2 = t * t, t3 = t2 * t;
    return {(2.0 * t3 - 3.0 * t2 + 1.0) * y0 + (t3 - 2.0 * t2 + t) * m0 + (3.0 * t2 - 2.0 * t3) * y1 + (t3 - t2) * m1,
            ((6.0 * t2 - 6.0 * t) * (y0 - y1) + (3.0 * t2 - 4.0 * t + 1.0) * m0 + (3.0 * t2 - 2.0 * t) * m1) / h};
}

HeartState initial_state(const HeartSpec& spec) {
    HeartState state;
    state.phase = wrap(spec.initial_phase);
    const ProfileValue value = profile(spec, state.phase);
    state.displacement_mm = value.displacement_mm;
    state.velocity_mm_s = value.slope_mm * spec.rate_bpm / 60.0;
    return state;
}

void advance(const HeartSpec& spec, HeartState& state, double dt, double rate_scale) {
    const double beats_per_s = spec.rate_bpm / 60.0 * rate_scale;
    const double phase = state.phase + dt * beats_per_s;
    state.beats += static_cast<std::int64_t>(std::floor(phase));
    state.phase = wrap(phase);
    const ProfileValue value = profile(spec, state.phase);
    state.displacement_mm = value.displacement_mm;
    state.velocity_mm_s = value.slope_mm * beats_per_s;
}

Pose cylinder_pose(const HeartSpec& spec, const Pose& annulus, double displacement_mm) {
    Pose pose;
    pose.orientation = (annulus.orientation * det::rotation_from_vector(spec.tilt_rad)).normalized();
    pose.position = annulus.position + (displacement_mm - spec.rest_gap_mm) * (pose.orientation * Vec3::UnitZ());
    return pose;
}

}  // namespace cathlab
