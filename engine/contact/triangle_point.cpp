#include "contact/triangle_point.h"

namespace cathlab {
namespace {

TrianglePoint at_corner(const Vec3& p, const Vec3& corner, int k) {
    TrianglePoint r;
    r.barycentric[k] = 1.0;
    r.point = corner;
    r.squared_distance = (p - corner).squaredNorm();
    r.feature = k;
    return r;
}

/// On the edge from corner k (at s = 0) to k + 1 (at s = 1), 0 < s < 1.
TrianglePoint on_edge(const Vec3& p, const Vec3& from, const Vec3& to, double s, int k) {
    TrianglePoint r;
    r.barycentric[k] = 1.0 - s;
    r.barycentric[(k + 1) % 3] = s;
    r.point = from + s * (to - from);
    r.squared_distance = (p - r.point).squaredNorm();
    r.feature = 3 + k;
    return r;
}

TrianglePoint on_segment(const Vec3& p, const Vec3& from, const Vec3& to, int k) {
    const Vec3 along = to - from;
    const double length2 = along.squaredNorm();
    const double s = length2 > 0.0 ? along.dot(p - from) / length2 : 0.0;
    if (!(s > 0.0)) return at_corner(p, from, k);
    if (s >= 1.0) return at_corner(p, to, (k + 1) % 3);
    return on_edge(p, from, to, s, k);
}

TrianglePoint on_sliver(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
    TrianglePoint best = on_segment(p, a, b, 0);
    const TrianglePoint bc = on_segment(p, b, c, 1);
    if (bc.squared_distance < best.squared_distance) best = bc;
    const TrianglePoint ca = on_segment(p, c, a, 2);
    return ca.squared_distance < best.squared_distance ? ca : best;
}

}  // namespace

TrianglePoint closest_on_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
    const Vec3 ab = b - a;
    const Vec3 ac = c - a;
    const Vec3 ap = p - a;
    const double d1 = ab.dot(ap);
    const double d2 = ac.dot(ap);
    if (d1 <= 0.0 && d2 <= 0.0) return at_corner(p, a, 0);

    const Vec3 bp = p - b;
    const double d3 = ab.dot(bp);
    const double d4 = ac.dot(bp);
    if (d3 >= 0.0 && d4 <= d3) return at_corner(p, b, 1);

    const Vec3 cp = p - c;
    const double d5 = ab.dot(cp);
    const double d6 = ac.dot(cp);
    if (d6 >= 0.0 && d5 <= d6) return at_corner(p, c, 2);

    // Below, the area decides; where rounding eats it (height under 1e-10 of the longest side) only the edges can be
    // trusted.
    const double ab2 = ab.squaredNorm();
    const double ac2 = ac.squaredNorm();
    const double longest2 = ab2 > ac2 ? ab2 : ac2;
    const double area2 = ab.cross(ac).squaredNorm();
    if (!(area2 > 1e-20 * longest2 * longest2)) return on_sliver(p, a, b, c);

    const double vc = d1 * d4 - d3 * d2;
    if (vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0) return on_segment(p, a, b, 0);
    const double vb = d5 * d2 - d1 * d6;
    if (vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0) return on_segment(p, c, a, 2);
    const double va = d3 * d6 - d5 * d4;
    if (va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0) return on_segment(p, b, c, 1);

    const double sum = va + vb + vc;
    if (!(sum > 0.0)) return on_sliver(p, a, b, c);
    TrianglePoint r;
    const double v = vb / sum;
    const double w = vc / sum;
    r.barycentric = Vec3(1.0 - v - w, v, w);
    r.point = a + v * ab + w * ac;
    r.squared_distance = (p - r.point).squaredNorm();
    r.feature = 6;
    return r;
}

}  // namespace cathlab
