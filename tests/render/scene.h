// Shapes whose shadows have closed forms, for the tests of this room.
#pragma once

#include <cmath>

#include "core/mesh.h"
#include "core/units.h"
#include "render/frame_description.h"

namespace cathlab::testing_shapes {

inline TriMesh box(const Vec3& low, const Vec3& high) {
    TriMesh m;
    for (int i = 0; i < 8; ++i) {
        m.vertices.emplace_back((i & 1) != 0 ? high.x() : low.x(), (i & 2) != 0 ? high.y() : low.y(),
                                (i & 4) != 0 ? high.z() : low.z());
    }
    const auto quad = [&](Index a, Index b, Index c, Index d) {
        m.triangles.emplace_back(a, b, c);
        m.triangles.emplace_back(a, c, d);
    };
    quad(0, 2, 3, 1);
    quad(4, 5, 7, 6);
    quad(0, 1, 5, 4);
    quad(2, 6, 7, 3);
    quad(0, 4, 6, 2);
    quad(1, 3, 7, 5);
    return m;
}

/// n rings; about 4 n^2 triangles.
inline TriMesh sphere(const Vec3& center, double radius, int n) {
    TriMesh m;
    const int around = 2 * n;
    m.vertices.emplace_back(center + Vec3(0, 0, radius));
    for (int i = 1; i < n; ++i) {
        for (int j = 0; j < around; ++j) {
            const double t = units::pi * i / n, p = units::pi * j / n;
            m.vertices.emplace_back(center +
                                    radius * Vec3(std::sin(t) * std::cos(p), std::sin(t) * std::sin(p), std::cos(t)));
        }
    }
    const auto last = static_cast<Index>(m.vertices.size());
    m.vertices.emplace_back(center - Vec3(0, 0, radius));
    const auto id = [&](int i, int j) { return static_cast<Index>(1 + (i - 1) * around + j % around); };
    for (int j = 0; j < around; ++j) {
        m.triangles.emplace_back(0, id(1, j), id(1, j + 1));
        m.triangles.emplace_back(last, id(n - 1, j + 1), id(n - 1, j));
    }
    for (int i = 1; i + 1 < n; ++i) {
        for (int j = 0; j < around; ++j) {
            m.triangles.emplace_back(id(i, j), id(i + 1, j), id(i, j + 1));
            m.triangles.emplace_back(id(i, j + 1), id(i + 1, j), id(i + 1, j + 1));
        }
    }
    return m;
}

/// Along the z axis.
inline TriMesh cylinder(const Vec3& center, double radius, double length, int sides) {
    TriMesh m;
    for (int j = 0; j < sides; ++j) {
        const double p = 2 * units::pi * j / sides;
        const Vec3 rim(radius * std::cos(p), radius * std::sin(p), 0);
        m.vertices.emplace_back(center + rim - Vec3(0, 0, length / 2));
        m.vertices.emplace_back(center + rim + Vec3(0, 0, length / 2));
    }
    const auto low = static_cast<Index>(m.vertices.size());
    m.vertices.emplace_back(center - Vec3(0, 0, length / 2));
    m.vertices.emplace_back(center + Vec3(0, 0, length / 2));
    for (int j = 0; j < sides; ++j) {
        const auto a = static_cast<Index>(2 * j), b = static_cast<Index>(2 * ((j + 1) % sides));
        m.triangles.emplace_back(a, b, b + 1);
        m.triangles.emplace_back(a, b + 1, a + 1);
        m.triangles.emplace_back(low, b, a);
        m.triangles.emplace_back(low + 1, a + 1, b + 1);
    }
    return m;
}

/// Round the z axis; 2 around across triangles.
inline TriMesh torus(const Vec3& center, double ring, double tube, int around, int across) {
    TriMesh m;
    for (int i = 0; i < around; ++i) {
        for (int j = 0; j < across; ++j) {
            const double p = 2 * units::pi * i / around, t = 2 * units::pi * j / across;
            const double reach = ring + tube * std::cos(t);
            m.vertices.emplace_back(center + Vec3(reach * std::cos(p), reach * std::sin(p), tube * std::sin(t)));
        }
    }
    const auto id = [&](int i, int j) { return static_cast<Index>((i % around) * across + j % across); };
    for (int i = 0; i < around; ++i) {
        for (int j = 0; j < across; ++j) {
            m.triangles.emplace_back(id(i, j), id(i + 1, j), id(i + 1, j + 1));
            m.triangles.emplace_back(id(i, j), id(i + 1, j + 1), id(i, j + 1));
        }
    }
    return m;
}

/// A C-arm turned by primary_deg (+ = detector to the patient's left), isocentre at the origin, SID 1200, SOD 800.
inline CArmView view(double primary_deg, double field_mm) {
    const double a = primary_deg * units::deg;
    const Vec3 forward(std::sin(a), -std::cos(a), 0);
    CArmView v;
    v.source = -800 * forward;
    v.detector_center = 400 * forward;
    v.right = Vec3(std::cos(a), std::sin(a), 0);
    v.down = Vec3(0, 0, -1);
    v.width_mm = v.height_mm = field_mm;
    return v;
}

/// Length of the line inside a ball.
inline double ball_chord(const Vec3& origin, const Vec3& direction, const Vec3& center, double radius) {
    const Vec3 rel = center - origin;
    const double off = (rel - rel.dot(direction) * direction).squaredNorm();
    return off < radius * radius ? 2 * std::sqrt(radius * radius - off) : 0.0;
}

/// Length of the line inside a torus round the z axis: the quartic's roots, bracketed in steps and bisected.
inline double torus_chord(const Vec3& origin, const Vec3& direction, const Vec3& center, double ring, double tube) {
    const auto outside = [&](double t) {
        const Vec3 p = origin + t * direction - center;
        return std::pow(std::hypot(p.x(), p.y()) - ring, 2) + p.z() * p.z() - tube * tube;
    };
    const double middle = (center - origin).dot(direction), reach = ring + tube + 1;
    double length = 0, from = 0;
    const double step = tube / 40;
    for (double t = middle - reach; t < middle + reach; t += step) {
        if ((outside(t) > 0) == (outside(t + step) > 0)) continue;
        double low = t, high = t + step;
        for (int i = 0; i < 50; ++i) {
            const double half = 0.5 * (low + high);
            ((outside(half) > 0) == (outside(t) > 0) ? low : high) = half;
        }
        if (outside(t) > 0)
            from = low;
        else
            length += low - from;
    }
    return length;
}

}  // namespace cathlab::testing_shapes
