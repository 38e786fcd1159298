#include "catheter/rail.h"

#include <algorithm>
#include <cmath>

#include "core/check.h"

namespace cathlab {
namespace {

constexpr std::size_t samples_per_span = 3;  // fixed: a count that followed the moving lengths would make the rail jump

// One pass of the triangular kernel.  It shrinks towards both ends, so that the ends stay and the kernel keeps its
// symmetry.
std::vector<Vec3> averaged_once(const std::vector<Vec3>& nodes, std::span<const double> radius,
                                const RailShape& shape) {
    std::vector<double> arc(nodes.size(), 0.0);
    for (std::size_t i = 1; i < nodes.size(); ++i)
        arc[i] = arc[i - 1] + std::sqrt((nodes[i] - nodes[i - 1]).squaredNorm());
    std::vector<Vec3> out = nodes;
    for (std::size_t i = 1; i + 1 < nodes.size(); ++i) {
        const double half =
            std::min({shape.smoothing_radii * radius[i], shape.smoothing_max_mm, arc[i], arc.back() - arc[i]});
        if (half < 1e-9) continue;
        Vec3 sum = nodes[i];
        double weight = 1.0;
        const auto take = [&](std::size_t j, double distance) {
            sum += (1.0 - distance / half) * nodes[j];
            weight += 1.0 - distance / half;
        };
        for (std::size_t j = i; j-- > 0 && arc[i] - arc[j] < half;) take(j, arc[i] - arc[j]);
        for (std::size_t j = i + 1; j < nodes.size() && arc[j] - arc[i] < half; ++j) take(j, arc[j] - arc[i]);
        out[i] = sum / weight;
    }
    return out;
}

std::vector<Vec3> averaged(const std::vector<Vec3>& nodes, std::span<const double> radius, const RailShape& shape) {
    std::vector<Vec3> out = averaged_once(averaged_once(nodes, radius, shape), radius, shape);
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        const Vec3 shift = out[i] - nodes[i];
        const double limit = std::max(shape.deviation_limit * radius[i], 1e-6);
        const double ratio = shift.squaredNorm() / (limit * limit);
        out[i] = nodes[i] +
                 shift / std::sqrt(std::sqrt(1.0 + ratio * ratio));  // untouched well below the limit, never beyond
    }
    return out;
}

Vec3 any_square_to(const Vec3& t, const Vec3& wanted) {
    Vec3 side = wanted - t * t.dot(wanted);
    if (side.squaredNorm() < 1e-6) {
        const Vec3 other = std::fabs(t.x()) < 0.7 ? Vec3::UnitX() : Vec3::UnitY();
        side = other - t * t.dot(other);
    }
    return side.normalized();
}

// Arc lengths, tangents and frames of rail.points.
void complete(Rail& rail, const Vec3& first_side) {
    const std::size_t n = rail.points.size();
    rail.arc.assign(n, 0.0);
    rail.tangent.assign(n, Vec3::UnitZ());
    rail.side.assign(n, Vec3::UnitX());
    for (std::size_t i = 1; i < n; ++i)
        rail.arc[i] = rail.arc[i - 1] + std::sqrt((rail.points[i] - rail.points[i - 1]).squaredNorm());
    for (std::size_t i = 0; i < n; ++i) {
        const Vec3 along = rail.points[std::min(i + 1, n - 1)] - rail.points[i > 0 ? i - 1 : 0];
        const double length = std::sqrt(along.squaredNorm());
        rail.tangent[i] = length > 1e-12 ? Vec3(along / length) : (i > 0 ? rail.tangent[i - 1] : Vec3(Vec3::UnitZ()));
    }
    rail.side[0] = any_square_to(rail.tangent[0], first_side);
    for (std::size_t i = 0; i + 1 < n; ++i) {
        // Double reflection: first in the plane between the points, then in the one between the tangents.
        const Vec3 v1 = rail.points[i + 1] - rail.points[i];
        const double c1 = v1.squaredNorm();
        Vec3 side = rail.side[i];
        if (c1 > 1e-18) {
            side -= (2.0 / c1) * v1.dot(side) * v1;
            const Vec3 reflected = rail.tangent[i] - (2.0 / c1) * v1.dot(rail.tangent[i]) * v1;
            const Vec3 v2 = rail.tangent[i + 1] - reflected;
            const double c2 = v2.squaredNorm();
            if (c2 > 1e-18) side -= (2.0 / c2) * v2.dot(side) * v2;
        }
        rail.side[i + 1] = any_square_to(rail.tangent[i + 1], side);
    }
}

// The segment of the rail that holds an arc length, and how far along it that lies (outside [0, 1] beyond the ends).
std::size_t locate(const Rail& rail, double arc_mm, double& part) {
    const auto above = std::upper_bound(rail.arc.begin(), rail.arc.end(), arc_mm);
    const auto last = rail.arc.size() - 2;
    const auto i =
        above == rail.arc.begin() ? 0 : std::min(static_cast<std::size_t>(above - rail.arc.begin()) - 1, last);
    const double span = rail.arc[i + 1] - rail.arc[i];
    part = span > 0.0 ? (arc_mm - rail.arc[i]) / span : 0.0;
    return i;
}

}  // namespace

Vec3 Rail::point(double arc_mm) const {
    if (arc_mm < 0.0 || arc_mm > arc.back()) return at(arc_mm).position;
    double part = 0.0;
    const std::size_t i = locate(*this, arc_mm, part);
    return points[i] + part * (points[i + 1] - points[i]);
}

Pose Rail::at(double arc_mm) const {
    CATHLAB_CHECK(points.size() >= 2, "a rail has two points or more");
    double part = 0.0;
    const std::size_t i = locate(*this, arc_mm, part);
    const double inside = std::clamp(part, 0.0, 1.0);
    const Vec3 z = (tangent[i] + inside * (tangent[i + 1] - tangent[i])).normalized();
    const Vec3 x = any_square_to(z, side[i] + inside * (side[i + 1] - side[i]));
    Mat3 axes;
    axes.col(0) = x;
    axes.col(1) = z.cross(x);
    axes.col(2) = z;
    Pose pose;
    pose.position = points[i] + inside * (points[i + 1] - points[i]);
    if (arc_mm < 0.0) pose.position += arc_mm * z;
    if (arc_mm > arc.back()) pose.position += (arc_mm - arc.back()) * z;
    pose.orientation = Quat(axes).normalized();
    return pose;
}

double Rail::led(double arc_mm) const {
    if (lead.empty()) return 0.0;
    double part = 0.0;
    const std::size_t i = locate(*this, arc_mm, part);
    return lead[i] + std::clamp(part, 0.0, 1.0) * (lead[i + 1] - lead[i]);
}

double rail_support_mm(const RailShape& shape) {
    return shape.smoothing_max_mm + 8.0;
}

Rail build_rail(const Pose& mouth, std::span<const Vec3> nodes, std::span<const double> radius,
                const RailShape& shape) {
    CATHLAB_CHECK(nodes.size() >= 2, "a rail needs two nodes or more");
    CATHLAB_CHECK(radius.empty() || radius.size() == nodes.size(), "one radius a node");
    std::vector<Vec3> control(nodes.begin(), nodes.end());
    control[0] = mouth.position;
    if (!radius.empty()) control = averaged(control, radius, shape);

    const std::size_t n = control.size();
    const auto knot = [&](std::size_t i) -> Vec3 {  // one phantom before and one behind: the spline reaches both ends
        if (i == 0) return 2.0 * control[0] - control[1];
        if (i == n + 1) return 2.0 * control[n - 1] - control[n - 2];
        return control[i - 1];
    };
    Rail rail;
    rail.points.reserve((n - 1) * samples_per_span + 1);
    rail.points.push_back(control[0]);
    for (std::size_t i = 0; i + 1 < n; ++i) {
        const Vec3 a = knot(i), b = knot(i + 1), c = knot(i + 2), d = knot(i + 3);
        for (std::size_t k = 1; k <= samples_per_span; ++k) {
            const double u = static_cast<double>(k) / static_cast<double>(samples_per_span);
            const double v = 1.0 - u;
            rail.points.push_back((v * v * v * a + (3.0 * u * u * u - 6.0 * u * u + 4.0) * b +
                                   (3.0 * v * v * v - 6.0 * v * v + 4.0) * c + u * u * u * d) /
                                  6.0);
        }
    }
    complete(rail, mouth.orientation * Vec3::UnitX());
    return rail;
}

Rail blend(const Rail& from, const Rail& to, double share) {
    if (share >= 1.0 || from.points.empty()) return to;
    Rail out;
    out.points.reserve(to.points.size());
    out.lead.reserve(to.points.size());
    for (std::size_t i = 0; i < to.points.size(); ++i) {
        const double arc = std::min(to.arc[i], from.length());
        out.points.push_back(to.points[i] + (1.0 - share) * (from.point(arc) - to.point(arc)));
        const double lead = to.lead.empty() ? 0.0 : to.lead[i];
        out.lead.push_back(lead + (1.0 - share) * (from.led(to.arc[i]) - lead));
    }
    complete(out, to.side.front());
    return out;
}

Rail laid_over_wire(const Rail& laid, const Rail& route, const Rail& wire, double tip_mm, double yielding) {
    constexpr double handing_over_mm = 20.0;
    Rail out;
    double kept_mm = 0.0;
    for (std::size_t i = 0; i < laid.points.size() && laid.arc[i] <= std::min(tip_mm, route.length()); ++i) {
        const Vec3 aside = route.point(laid.arc[i]) - laid.points[i];
        out.points.push_back(laid.points[i] + yielding * aside);
        kept_mm = laid.arc[i];
    }
    const auto ahead = [&](double arc) -> Vec3 {
        Vec3 on = route.point(arc);
        if (wire.points.empty()) return on;
        return on + wire_lead(wire.length(), arc, handing_over_mm) * (wire.point(arc) - on);
    };
    // What is ahead starts where the laid part ends.
    const Vec3 step = out.points.empty() ? Vec3(Vec3::Zero()) : Vec3(out.points.back() - ahead(kept_mm));
    constexpr double apart_mm = 0.5;  // of the last kept point and the next
    for (std::size_t i = 0; i < route.points.size(); ++i) {
        const double arc = route.arc[i];
        if (!out.points.empty() && arc < kept_mm + apart_mm) continue;
        const double fade = std::max(0.0, 1.0 - (arc - kept_mm) / handing_over_mm);
        out.points.push_back(ahead(arc) + fade * step);
    }
    if (out.points.size() < 2) return route;
    complete(out, route.side.front());
    return out;
}

double wire_lead(double wire_mm, double base_mm, double over_mm) {
    const double t = std::clamp((wire_mm - base_mm) / over_mm, 0.0, 1.0);
    return t * t * (3.0 - 2.0 * t);
}

}  // namespace cathlab
