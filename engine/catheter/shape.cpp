#include "catheter/shape.h"

#include <algorithm>
#include <cmath>

#include "core/check.h"
#include "core/deterministic_math.h"

namespace cathlab {
namespace {

struct Piece {
    double length, bend, direction;
};

constexpr int parts_of_a_taper = 6;  // of a segment whose curvature changes along it

/// The part of the bend that part k takes.
double taper_share(double taper, int k) {
    return (1.0 + taper * ((2.0 * k + 1.0) / parts_of_a_taper - 1.0)) / parts_of_a_taper;
}

std::vector<Piece> pieces_of(const CatheterSpec& spec, const CatheterState& state) {
    std::vector<Piece> pieces;
    for (std::size_t i = 0; i < spec.segments.size(); ++i) {
        if (i > 0 && spec.link_length_mm > 0.0) pieces.push_back({spec.link_length_mm, 0.0, 0.0});
        const double taper = i < state.taper.size() ? state.taper[i] : 0.0;
        if (taper == 0.0) {
            pieces.push_back({spec.segments[i].length_mm, state.bend_rad[i], state.direction_rad[i]});
            continue;
        }
        for (int k = 0; k < parts_of_a_taper; ++k) {
            pieces.push_back({spec.segments[i].length_mm / parts_of_a_taper, taper_share(taper, k) * state.bend_rad[i],
                              state.direction_rad[i]});
        }
    }
    if (spec.tip_length_mm > 0.0) pieces.push_back({spec.tip_length_mm, 0.0, 0.0});
    return pieces;
}

// The rail's bend between two arc lengths as a vector across the catheter (its x and y), which is turned by `rotation`
// against the rail's frame, radians.
Vec2 rail_bend(const Rail& rail, double from, double to, double rotation) {
    const Vec3 ahead = rail.at(from).orientation.conjugate() * (rail.at(to).orientation * Vec3::UnitZ());
    const double across = std::sqrt(ahead.x() * ahead.x() + ahead.y() * ahead.y());
    if (across < 1e-12) return Vec2::Zero();
    const double angle = det::atan2(across, ahead.z()) / across;
    const double c = det::cos(rotation), s = det::sin(rotation);
    return angle * Vec2(c * ahead.x() + s * ahead.y(), c * ahead.y() - s * ahead.x());
}

// Walks on with a bend of its own (radians a mm), of which a guidewire inside leaves a share, and the rest the rail's.
Pose walk(const Pose& start, const Rail& rail, double from, double to, const Vec2& own, double rotation) {
    const double length = to - from;
    const double led = rail.led(0.5 * (from + to));
    Vec2 bend = length * own;
    if (led > 0.0) bend = (1.0 - led) * bend + led * rail_bend(rail, from, to, rotation);
    const double angle = std::sqrt(bend.squaredNorm());
    return along_arc(start, length, angle, angle > 0.0 ? det::atan2(bend.y(), bend.x()) : 0.0);
}

Pose rotated_about_z(const Pose& pose, double angle) {
    return {pose.position, pose.orientation * det::rotation_from_vector(Vec3(0.0, 0.0, angle))};
}

}  // namespace

Pose along_arc(const Pose& start, double length, double bend, double direction) {
    const double c = det::cos(direction);
    const double s = det::sin(direction);
    double out = 0.5 * length * bend;  // first order of (1 - cos beta) / beta
    double on = length;
    if (std::fabs(bend) > 1e-8) {
        out = length * (1.0 - det::cos(bend)) / bend;
        on = length * det::sin(bend) / bend;
    }
    Pose end;
    end.position = start.to_world(Vec3(out * c, out * s, on));
    // Rz(phi) Ry(beta) Rz(-phi) is the turn by beta about (-sin phi, cos phi, 0).
    end.orientation = (start.orientation * det::rotation_from_vector(Vec3(-bend * s, bend * c, 0.0))).normalized();
    return end;
}

Pose segment_end(const Pose& start, double length, const Vec2& bend, double taper) {
    if (taper != 0.0) {
        Pose at = start;
        for (int k = 0; k < parts_of_a_taper; ++k)
            at = segment_end(at, length / parts_of_a_taper, taper_share(taper, k) * bend, 0.0);
        return at;
    }
    const double angle = std::sqrt(bend.squaredNorm());
    if (angle < 1e-8) return along_arc(start, length, 0.0, 0.0);
    // along_arc by half angles: 1 - cos b = 2 s^2, sin b = 2 s c.
    const double s = det::sin(0.5 * angle), c = det::cos(0.5 * angle);
    const Vec2 way = bend / angle;
    Pose end;
    const double out = 2.0 * length * s * s / angle;
    end.position = start.to_world(Vec3(out * way.x(), out * way.y(), 2.0 * length * s * c / angle));
    end.orientation = start.orientation * Quat(c, -s * way.y(), s * way.x(), 0.0);
    return end;
}

double base_arc_mm(const CatheterSpec& spec, const CatheterState& state) {
    return state.insertion_mm - spec.steerable_length_mm();
}

CatheterShape shape(const CatheterSpec& spec, const CatheterState& state, const Rail& rail, double spacing_mm) {
    CATHLAB_CHECK(spacing_mm > 0.0, "spacing of the samples");
    const double base_arc = base_arc_mm(spec, state);
    CatheterShape out;
    out.base = rotated_about_z(rail.at(std::max(base_arc, 0.0)), state.rotation_rad);

    const auto count = static_cast<std::size_t>(state.insertion_mm / spacing_mm);  // whole spacings behind the tip
    const double first = state.insertion_mm - static_cast<double>(count) * spacing_mm;
    out.points.reserve(count + 2);
    out.arc.reserve(count + 2);
    const auto add = [&](double arc, const Vec3& p) {
        out.arc.push_back(arc);
        out.points.push_back(p);
    };
    if (first > 1e-9 || count == 0) add(0.0, rail.point(0.0));

    // Along the catheter: samples at first + k spacing.
    std::size_t k = 0;
    const auto arc_of = [&](std::size_t i) { return first + static_cast<double>(i) * spacing_mm; };
    for (; k <= count && arc_of(k) < base_arc; ++k) add(arc_of(k), rail.point(arc_of(k)));

    Pose start = out.base;
    double begin = base_arc;
    for (const Piece& piece : pieces_of(spec, state)) {
        const double end = begin + piece.length;
        double at = std::max(begin, std::min(end, 0.0));  // what is out of the sheath
        const Vec2 own = piece.bend / piece.length * Vec2(det::cos(piece.direction), det::sin(piece.direction));
        const auto go = [&](double to) {
            if (to <= at) return;
            start = walk(start, rail, at, to, own, state.rotation_rad);
            at = to;
        };
        for (; k <= count && arc_of(k) <= end; ++k) {
            go(arc_of(k));
            if (arc_of(k) > 0.0 || out.points.empty()) add(arc_of(k), start.position);
        }
        go(end);
        begin = end;
    }
    out.tip = start;
    for (; k <= count && (arc_of(k) > 0.0 || out.points.empty()); ++k)
        add(arc_of(k), out.tip.position);  // rounding of the sums
    return out;
}

std::vector<Vec3> steering_guide(const CatheterSpec& spec, const CatheterShape& shape, double prolonged_mm) {
    std::vector<Vec3> guide;
    const double base = shape.arc.back() - spec.steerable_length_mm();
    for (std::size_t i = 0; i < shape.points.size(); ++i)
        if (shape.arc[i] >= base) guide.push_back(shape.points[i]);
    guide.push_back(shape.tip.position + prolonged_mm * (shape.tip.orientation * Vec3::UnitZ()));
    return guide;
}

}  // namespace cathlab
