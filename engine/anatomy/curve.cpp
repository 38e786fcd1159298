#include "anatomy/curve.h"

#include <algorithm>
#include <cmath>

#include "core/deterministic_math.h"

namespace cathlab {
namespace {

std::size_t segment_of(const std::vector<double>& arc, double s) {
    const auto it = std::upper_bound(arc.begin(), arc.end(), s);
    const auto i = static_cast<std::size_t>(it - arc.begin());
    return std::clamp<std::size_t>(i, 1, arc.size() - 1) - 1;
}

double fraction(const std::vector<double>& arc, std::size_t i, double s) {
    const double width = arc[i + 1] - arc[i];
    return width > 0.0 ? std::clamp((s - arc[i]) / width, 0.0, 1.0) : 0.0;
}

void measure(Curve& c) {
    c.arc.assign(c.position.size(), 0.0);
    for (std::size_t i = 1; i < c.position.size(); ++i)
        c.arc[i] = c.arc[i - 1] + (c.position[i] - c.position[i - 1]).norm();
}

}  // namespace

Vec3 Curve::point(double s) const {
    const std::size_t i = segment_of(arc, s);
    return position[i] + fraction(arc, i, s) * (position[i + 1] - position[i]);
}

double Curve::radius_at(double s) const {
    const std::size_t i = segment_of(arc, s);
    return radius[i] + fraction(arc, i, s) * (radius[i + 1] - radius[i]);
}

Vec3 Curve::tangent(double s) const {
    const double reach = std::min(1.0, 0.5 * length());
    const double a = std::max(0.0, s - reach);
    const double b = std::min(length(), s + reach);
    return (point(b) - point(a)).normalized();
}

double Curve::nearest_arc(const Vec3& p) const {
    double best = 0.0;
    double best_distance = 1e300;
    for (std::size_t i = 0; i + 1 < position.size(); ++i) {
        const Vec3 ab = position[i + 1] - position[i];
        const double t = std::clamp((p - position[i]).dot(ab) / std::max(ab.squaredNorm(), 1e-30), 0.0, 1.0);
        const double d = (position[i] + t * ab - p).squaredNorm();
        if (d < best_distance) {
            best_distance = d;
            best = arc[i] + t * (arc[i + 1] - arc[i]);
        }
    }
    return best;
}

Curve sample_curve(std::span<const ControlPoint> points, double step, const Vec3* before) {
    const std::size_t n = points.size();
    std::vector<Vec3> p(n + 2);
    for (std::size_t i = 0; i < n; ++i) p[i + 1] = points[i].position;
    p[0] = before != nullptr ? *before : Vec3(2.0 * p[1] - p[2]);
    p[n + 1] = 2.0 * p[n] - p[n - 1];
    Curve out;
    out.position.push_back(p[1]);
    out.radius.push_back(points[0].radius);
    for (std::size_t i = 1; i < n; ++i) {
        double t[4] = {0.0, 0.0, 0.0, 0.0};  // knots: t grows by the square root of the chord
        for (std::size_t k = 1; k < 4; ++k)
            t[k] = t[k - 1] + std::sqrt(std::max((p[i + k - 1] - p[i + k - 2]).norm(), 1e-9));
        const double chord = (p[i + 1] - p[i]).norm();
        const int pieces = std::max(2, static_cast<int>(std::ceil(1.1 * chord / step)));
        for (int piece = 1; piece <= pieces; ++piece) {
            const double f = static_cast<double>(piece) / pieces;
            const double u = t[1] + f * (t[2] - t[1]);
            auto mix = [&](const Vec3& a, const Vec3& b, double ta, double tb) -> Vec3 {
                return ((tb - u) * a + (u - ta) * b) / (tb - ta);
            };
            const Vec3 a1 = mix(p[i - 1], p[i], t[0], t[1]);
            const Vec3 a2 = mix(p[i], p[i + 1], t[1], t[2]);
            const Vec3 a3 = mix(p[i + 1], p[i + 2], t[2], t[3]);
            const Vec3 b1 = mix(a1, a2, t[0], t[2]);
            const Vec3 b2 = mix(a2, a3, t[1], t[3]);
            out.position.push_back(piece == pieces ? p[i + 1] : mix(b1, b2, t[1], t[2]));
            const double smooth = f * f * (3.0 - 2.0 * f);
            out.radius.push_back(points[i - 1].radius + smooth * (points[i].radius - points[i - 1].radius));
        }
    }
    measure(out);
    return out;
}

void narrow(Curve& curve, const StenosisSpec& stenosis) {
    const double begin = stenosis.place_mm - 0.5 * stenosis.length_mm;
    const double end = stenosis.place_mm + 0.5 * stenosis.length_mm;
    const double step = std::min(0.25, stenosis.length_mm / 40.0);
    Curve fine;
    for (std::size_t i = 0; i < curve.position.size(); ++i) {
        fine.position.push_back(curve.position[i]);
        fine.radius.push_back(curve.radius[i]);
        if (i + 1 == curve.position.size() || curve.arc[i + 1] < begin || curve.arc[i] > end) continue;
        const double width = curve.arc[i + 1] - curve.arc[i];
        const int pieces = static_cast<int>(std::ceil(width / step));
        for (int k = 1; k < pieces; ++k) {
            const double s = curve.arc[i] + width * k / pieces;
            fine.position.push_back(curve.point(s));
            fine.radius.push_back(curve.radius_at(s));
        }
    }
    measure(fine);
    for (std::size_t i = 0; i < fine.position.size(); ++i) {
        const double u = (fine.arc[i] - stenosis.place_mm) / stenosis.length_mm;
        if (std::fabs(u) >= 0.5) continue;
        fine.radius[i] *= 1.0 - stenosis.degree * 0.5 * (1.0 + det::cos(2.0 * 3.14159265358979323846 * u));
    }
    curve = std::move(fine);
}

}  // namespace cathlab
