#include "contact/lumen_surface.h"

#include <algorithm>
#include <utility>

#include "core/check.h"
#include "core/deterministic_math.h"

namespace cathlab {
namespace {

std::size_t at(Index i) {
    return static_cast<std::size_t>(i);
}

/// Angle at corner k by atan2(|a x b|, a . b): exact for thin triangles, 0 for degenerate ones.
double corner_angle(const std::vector<Vec3>& vertices, const Triangle& t, int k) {
    const Vec3& corner = vertices[at(t[k])];
    const Vec3 a = vertices[at(t[(k + 1) % 3])] - corner;
    const Vec3 b = vertices[at(t[(k + 2) % 3])] - corner;
    const double sine = a.cross(b).norm();
    return sine > 0.0 ? det::atan2(sine, a.dot(b)) : 0.0;
}

Vec3 unit_or_zero(const Vec3& v) {
    const double length = v.norm();
    return length > 1e-30 ? Vec3(v / length) : Vec3(Vec3::Zero());
}

void build_adjacency(LumenSurfaceModel& model, std::size_t vertex_count) {
    model.fan_start.assign(vertex_count + 1, 0);
    for (const Triangle& t : model.triangles) {
        for (int k = 0; k < 3; ++k) ++model.fan_start[at(t[k]) + 1];
    }
    for (std::size_t v = 0; v < vertex_count; ++v) model.fan_start[v + 1] += model.fan_start[v];
    model.fan.resize(3 * model.triangles.size());
    std::vector<Index> next(model.fan_start.begin(), model.fan_start.end() - 1);
    for (std::size_t t = 0; t < model.triangles.size(); ++t) {
        for (int k = 0; k < 3; ++k) model.fan[at(next[at(model.triangles[t][k])]++)] = static_cast<Index>(t);
    }
    model.across.assign(model.triangles.size(), Triangle(-1, -1, -1));
    for (std::size_t t = 0; t < model.triangles.size(); ++t) {
        for (int k = 0; k < 3; ++k) {
            const Index a = model.triangles[t][k];
            const Index b = model.triangles[t][(k + 1) % 3];
            for (Index f = model.fan_start[at(a)]; f < model.fan_start[at(a) + 1]; ++f) {
                const Index other = model.fan[at(f)];
                if (at(other) == t || model.across[t][k] >= 0) continue;
                const Triangle& o = model.triangles[at(other)];
                for (int j = 0; j < 3; ++j) {
                    if (o[j] == b && o[(j + 1) % 3] == a) model.across[t][k] = other;
                }
            }
        }
    }
}

}  // namespace

LumenSurfaceModel build_lumen_surface(const TriMesh& lumen, std::span<const Index> vertex_region,
                                      std::span<const double> vertex_radius, PointBinding binding) {
    const std::size_t n = lumen.vertices.size();
    CATHLAB_CHECK(vertex_region.empty() || vertex_region.size() == n, "one region a vertex");
    CATHLAB_CHECK(vertex_radius.empty() || vertex_radius.size() == n, "one radius a vertex");
    CATHLAB_CHECK(binding.start.size() == n + 1, "one binding a vertex");
    LumenSurfaceModel model;
    model.triangles = lumen.triangles;
    model.vertex_region.assign(n, 0);
    std::copy(vertex_region.begin(), vertex_region.end(), model.vertex_region.begin());
    model.vertex_radius.assign(n, 0.0);
    std::copy(vertex_radius.begin(), vertex_radius.end(), model.vertex_radius.begin());
    for (const Index r : model.vertex_region) {
        CATHLAB_CHECK(r >= 0, "regions count from 0");
        model.region_count = std::max(model.region_count, r + 1);
    }
    for (const Triangle& t : model.triangles) {
        CATHLAB_CHECK(t.minCoeff() >= 0 && at(t.maxCoeff()) < n, "triangle corner out of range");
    }
    for (const Index p : binding.particle) {
        CATHLAB_CHECK(p >= 0, "particle out of range");
        model.particle_count = std::max(model.particle_count, p + 1);
    }
    model.binding = std::move(binding);
    build_adjacency(model, n);
    model.triangle_region.reserve(model.triangles.size());
    for (const Triangle& t : model.triangles) {
        const Index a = model.vertex_region[at(t[0])];
        const Index b = model.vertex_region[at(t[1])];
        const Index c = model.vertex_region[at(t[2])];
        model.triangle_region.push_back(b == c ? b : a);
    }
    model.tree = build_surface_tree(model.triangles, lumen.vertices);
    return model;
}

void update(const LumenSurfaceModel& model, std::span<const Vec3> particle_positions, LumenSurfaceState& state,
            const Workers& workers) {
    CATHLAB_CHECK(particle_positions.size() >= at(model.particle_count), "the surface is bound to more particles");
    state.vertices.resize(model.vertex_count());
    evaluate_all(model.binding, particle_positions, state.vertices, workers);
    refit(model.tree, model.triangles, state.vertices, state.boxes, workers);
}

void update(const LumenSurfaceModel& model, std::span<const Vec3> particle_positions, const TreePart& part,
            LumenSurfaceState& state, const Workers& workers) {
    CATHLAB_CHECK(state.vertices.size() == model.vertex_count(), "the whole surface is updated before a part of it");
    workers.for_ranges(part.vertices.size(), 512, [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) {
            const std::size_t v = at(part.vertices[k]);
            state.vertices[v] = evaluate(model.binding, v, particle_positions);
        }
    });
    refit(model.tree, part, model.triangles, state.vertices, state.boxes, workers);
}

Vec3 inward_triangle_normal(const LumenSurfaceModel& model, const LumenSurfaceState& state, Index triangle) {
    const Triangle& t = model.triangles[at(triangle)];
    const Vec3& a = state.vertices[at(t[0])];
    return unit_or_zero((state.vertices[at(t[2])] - a).cross(state.vertices[at(t[1])] - a));
}

Vec3 inward_edge_normal(const LumenSurfaceModel& model, const LumenSurfaceState& state, Index triangle, int edge) {
    Vec3 sum = inward_triangle_normal(model, state, triangle);
    const Index other = model.across[at(triangle)][edge];
    if (other >= 0) sum += inward_triangle_normal(model, state, other);
    return unit_or_zero(sum);
}

Vec3 inward_vertex_normal(const LumenSurfaceModel& model, const LumenSurfaceState& state, Index vertex) {
    Vec3 sum = Vec3::Zero();
    for (Index f = model.fan_start[at(vertex)]; f < model.fan_start[at(vertex) + 1]; ++f) {
        const Index triangle = model.fan[at(f)];
        const Triangle& t = model.triangles[at(triangle)];
        for (int k = 0; k < 3; ++k) {
            if (t[k] == vertex) {
                sum += corner_angle(state.vertices, t, k) * inward_triangle_normal(model, state, triangle);
            }
        }
    }
    return unit_or_zero(sum);
}

Vec3 inward_smooth_normal(const LumenSurfaceModel& model, const LumenSurfaceState& state, Index triangle,
                          const Vec3& barycentric) {
    Vec3 blend = Vec3::Zero();
    for (int k = 0; k < 3; ++k) {
        if (barycentric[k] == 0.0) continue;
        const auto v = at(model.triangles[at(triangle)][k]);
        Vec3 sum = Vec3::Zero();
        for (Index f = model.fan_start[v]; f < model.fan_start[v + 1]; ++f) {
            const Triangle& t = model.triangles[at(model.fan[at(f)])];
            const Vec3& a = state.vertices[at(t[0])];
            sum += (state.vertices[at(t[2])] - a).cross(state.vertices[at(t[1])] - a);
        }
        blend += barycentric[k] * unit_or_zero(sum);
    }
    return unit_or_zero(blend);
}

double lumen_radius(const LumenSurfaceModel& model, Index triangle, const Vec3& barycentric) {
    const Triangle& t = model.triangles[at(triangle)];
    return barycentric[0] * model.vertex_radius[at(t[0])] + barycentric[1] * model.vertex_radius[at(t[1])] +
           barycentric[2] * model.vertex_radius[at(t[2])];
}

}  // namespace cathlab
