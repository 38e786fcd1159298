// Closed surfaces for the tests of contact, and the slow, simple answers to compare with.
#pragma once

#include <cmath>
#include <functional>
#include <numbers>

#include "contact/closest_point.h"
#include "core/check.h"
#include "core/random.h"
#include "core/winding.h"

namespace cathlab::test {

inline double uniform(std::uint64_t step, std::uint64_t index, double low, double high) {
    return low + (high - low) * random_uniform(11, RandomStream::test, step, index);
}
inline Vec3 uniform_vector(std::uint64_t step, std::uint64_t index, double half) {
    return {uniform(step, 3 * index, -half, half), uniform(step, 3 * index + 1, -half, half),
            uniform(step, 3 * index + 2, -half, half)};
}

/// Triangles between `rings` rings of `round` vertices each; ring r follows ring r - 1 along the tube.
inline void add_rings(TriMesh& mesh, Index first, int rings, int round, bool closed) {
    for (int r = 0; r + 1 < rings + (closed ? 1 : 0); ++r) {
        for (int k = 0; k < round; ++k) {
            const Index a = first + r * round + k;
            const Index b = first + r * round + (k + 1) % round;
            const Index c = first + ((r + 1) % rings) * round + k;
            const Index d = first + ((r + 1) % rings) * round + (k + 1) % round;
            mesh.triangles.emplace_back(a, b, d);
            mesh.triangles.emplace_back(a, d, c);
        }
    }
}

/// A tube with flat ends about a planar curve (in the xz plane), appended to mesh.
inline void add_tube(TriMesh& mesh, const std::function<Vec3(double)>& curve, double radius, int rings, int round) {
    const auto first = static_cast<Index>(mesh.vertices.size());
    for (int r = 0; r < rings; ++r) {
        const double s = static_cast<double>(r) / (rings - 1);
        const Vec3 tangent = (curve(s + 1e-4) - curve(s - 1e-4)).normalized();
        const Vec3 u = Vec3::UnitY().cross(tangent).normalized();
        const Vec3 v = tangent.cross(u);
        for (int k = 0; k < round; ++k) {
            const double phi = 2.0 * std::numbers::pi * k / round;
            mesh.vertices.push_back(curve(s) + radius * (std::cos(phi) * u + std::sin(phi) * v));
        }
    }
    add_rings(mesh, first, rings, round, false);
    const auto start = static_cast<Index>(mesh.vertices.size());
    mesh.vertices.push_back(curve(0.0));
    mesh.vertices.push_back(curve(1.0));
    const Index last = first + (rings - 1) * round;
    for (int k = 0; k < round; ++k) {
        mesh.triangles.emplace_back(start, first + (k + 1) % round, first + k);
        mesh.triangles.emplace_back(start + 1, last + k, last + (k + 1) % round);
    }
}

inline TriMesh straight_tube(double radius, double length, int rings, int round, const Vec3& offset = Vec3::Zero()) {
    TriMesh mesh;
    add_tube(
        mesh, [&](double s) { return Vec3(offset + Vec3(0, 0, s * length)); }, radius, rings, round);
    return mesh;
}

inline TriMesh torus(double ring_radius, double tube_radius, int rings, int round) {
    TriMesh mesh;
    for (int r = 0; r < rings; ++r) {
        const double theta = 2.0 * std::numbers::pi * r / rings;
        const Vec3 out(std::cos(theta), 0.0, std::sin(theta));
        for (int k = 0; k < round; ++k) {
            const double phi = -2.0 * std::numbers::pi * k / round;
            mesh.vertices.push_back((ring_radius + tube_radius * std::cos(phi)) * out +
                                    tube_radius * std::sin(phi) * Vec3::UnitY());
        }
    }
    add_rings(mesh, 0, rings, round, true);
    if (signed_volume(mesh) < 0.0) {
        for (Triangle& t : mesh.triangles) std::swap(t[1], t[2]);
    }
    return mesh;
}

/// Every vertex is a particle of its own.
inline PointBinding one_to_one(std::size_t vertices) {
    PointBinding binding;
    for (std::size_t v = 0; v < vertices; ++v) {
        binding.start.push_back(static_cast<Index>(v));
        binding.particle.push_back(static_cast<Index>(v));
        binding.weight.push_back(1.0);
    }
    binding.start.push_back(static_cast<Index>(vertices));
    return binding;
}

struct Surface {
    explicit Surface(const TriMesh& mesh, int threads = 1)
        : model(build_lumen_surface(mesh, {}, {}, one_to_one(mesh.vertices.size()))), particles(mesh.vertices) {
        update(model, particles, state, Workers(threads));
    }
    void move_to(const std::vector<Vec3>& to) {
        particles = to;
        update(model, particles, state, Workers(1));
    }
    LumenSurfaceModel model;
    LumenSurfaceState state;
    std::vector<Vec3> particles;
};

/// Smooth and large: bends, twists and swells by some millimetres over 20 mm.
inline std::vector<Vec3> deformed(const std::vector<Vec3>& rest, double amount) {
    std::vector<Vec3> out;
    for (const Vec3& p : rest) {
        out.push_back(p + amount * Vec3(std::sin(0.21 * p.z() + 0.3), std::sin(0.17 * p.x() + 0.13 * p.z()),
                                        0.6 * std::sin(0.15 * p.y() + 0.11 * p.x())));
    }
    return out;
}

/// Squared distance to a triangle by another road than the engine's: the foot of the plane if it lies inside, else the
/// edges.
inline double slow_distance(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
    const Vec3 n = (b - a).cross(c - a);
    const auto edge = [&](const Vec3& from, const Vec3& to) {
        const double s = std::clamp((p - from).dot(to - from) / (to - from).squaredNorm(), 0.0, 1.0);
        return (p - from - s * (to - from)).norm();
    };
    double best = std::min({edge(a, b), edge(b, c), edge(c, a)});
    const Vec3 foot = p - n * (n.dot(p - a) / n.squaredNorm());
    if (n.dot((b - a).cross(foot - a)) >= 0 && n.dot((c - b).cross(foot - b)) >= 0 &&
        n.dot((a - c).cross(foot - c)) >= 0) {
        best = std::min(best, (p - foot).norm());
    }
    return best;
}

/// Distance by brute force, side by the winding number.
inline double slow_signed_distance(const Surface& s, const Vec3& p) {
    double nearest = 1e300;
    for (const Triangle& t : s.model.triangles) {
        const Vec3& a = s.state.vertices[static_cast<std::size_t>(t[0])];
        const Vec3& b = s.state.vertices[static_cast<std::size_t>(t[1])];
        const Vec3& c = s.state.vertices[static_cast<std::size_t>(t[2])];
        nearest = std::min(nearest, slow_distance(p, a, b, c));
    }
    return winding(s.model.triangles, s.state.vertices, p) > 0.5 ? nearest : -nearest;
}

}  // namespace cathlab::test
