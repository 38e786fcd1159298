#include "softbody/tube.h"

#include <algorithm>
#include <cmath>

#include "core/deterministic_math.h"
#include "core/units.h"

namespace cathlab {

namespace {

void add_cap(TriMesh& mesh, const TubeShape& shape, const Vec3& u, const Vec3& w, double along, Index rim, Index around,
             bool far_end) {
    // Rings of the same number of vertices shrink towards one in the middle.
    const int rings = std::max(1, static_cast<int>(std::lround(shape.radius_mm / shape.edge_mm)));
    Index outer = rim;
    const auto add_triangle = [&](Index a, Index b, Index c) {
        if (far_end)
            mesh.triangles.emplace_back(a, b, c);
        else
            mesh.triangles.emplace_back(a, c, b);
    };
    for (int ring = rings - 1; ring >= 1; --ring) {
        const double r = shape.radius_mm * ring / rings;
        const auto inner = static_cast<Index>(mesh.vertices.size());
        for (Index k = 0; k < around; ++k) {
            const double angle = 2.0 * units::pi * k / around;
            mesh.vertices.push_back(shape.start + along * shape.axis + r * (det::cos(angle) * u + det::sin(angle) * w));
        }
        for (Index k = 0; k < around; ++k) {
            const Index next = (k + 1) % around;
            add_triangle(outer + k, outer + next, inner + next);
            add_triangle(outer + k, inner + next, inner + k);
        }
        outer = inner;
    }
    const auto middle = static_cast<Index>(mesh.vertices.size());
    mesh.vertices.push_back(shape.start + along * shape.axis);
    for (Index k = 0; k < around; ++k) add_triangle(outer + k, outer + (k + 1) % around, middle);
}

}  // namespace

TriMesh tube_mesh(const TubeShape& shape) {
    const Vec3 u = shape.axis.unitOrthogonal();
    const Vec3 w = shape.axis.cross(u);
    const auto around =
        static_cast<Index>(std::max(12L, std::lround(2.0 * units::pi * shape.radius_mm / shape.edge_mm)));
    const auto rows = static_cast<Index>(std::max(1L, std::lround(shape.length_mm / (0.87 * shape.edge_mm))));
    TriMesh mesh;
    for (Index row = 0; row <= rows; ++row) {
        const double along = shape.length_mm * row / rows;
        for (Index k = 0; k < around; ++k) {
            const double angle = 2.0 * units::pi * (k + 0.5 * (row % 2)) / around;  // staggered rows: even triangles
            mesh.vertices.push_back(shape.start + along * shape.axis +
                                    shape.radius_mm * (det::cos(angle) * u + det::sin(angle) * w));
        }
    }
    for (Index row = 0; row < rows; ++row) {
        const Index low = row * around, high = low + around;
        for (Index k = 0; k < around; ++k) {
            const Index next = (k + 1) % around;
            if (row % 2 == 0) {
                mesh.triangles.emplace_back(low + k, low + next, high + k);
                mesh.triangles.emplace_back(low + next, high + next, high + k);
            } else {
                mesh.triangles.emplace_back(low + k, low + next, high + next);
                mesh.triangles.emplace_back(low + k, high + next, high + k);
            }
        }
    }
    if (shape.closed) {
        add_cap(mesh, shape, u, w, 0.0, 0, around, false);
        add_cap(mesh, shape, u, w, shape.length_mm, rows * around, around, true);
    }
    return mesh;
}

TubeShape tube_for(std::size_t particles, double spacing_mm) {
    constexpr double radii_long = 500.0 / 12.0;
    constexpr double packing = 1.07;  // particles on spacing^2 of a mesh whose edges are half the spacing, measured
    TubeShape shape;
    shape.radius_mm = spacing_mm * std::sqrt(static_cast<double>(particles) / (packing * 2.0 * units::pi * radii_long));
    shape.length_mm = radii_long * shape.radius_mm;
    shape.edge_mm = 0.5 * spacing_mm;
    shape.closed = false;
    return shape;
}

WallSample tube_sample(const TubeShape& shape, double spacing_mm, double thickness_mm, std::uint64_t seed) {
    const TriMesh mesh = tube_mesh(shape);
    const std::vector<double> spacing(mesh.vertices.size(), spacing_mm);
    const std::vector<double> thickness{thickness_mm};
    WallSample sample = sample_wall(mesh, std::vector<Index>(mesh.vertices.size(), 0), spacing, thickness, seed);
    sample.along.assign(sample.position.size(), shape.axis);
    return sample;
}

}  // namespace cathlab
