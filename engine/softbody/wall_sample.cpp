#include "softbody/wall_sample.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <string>

#include "core/check.h"
#include "core/errors.h"
#include "core/units.h"
#include "softbody/geodesic.h"

namespace cathlab {

namespace {

constexpr double transition_slope = 0.3;  // growth of the spacing per mm away from a finer region
constexpr double dart_radius = 0.83;      // 1.44 * 0.83^2 = 0.99: a particle for each spacing^2
constexpr int relaxation_rounds = 3;

std::size_t at(Index i) {
    return static_cast<std::size_t>(i);
}

std::vector<std::pair<Index, Index>> mesh_edges(const TriMesh& mesh) {
    std::vector<std::pair<Index, Index>> edges;
    edges.reserve(3 * mesh.triangles.size());
    for (const Triangle& t : mesh.triangles)
        for (int k = 0; k < 3; ++k) edges.emplace_back(std::minmax(t[k], t[(k + 1) % 3]));
    std::sort(edges.begin(), edges.end());
    edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
    return edges;
}

std::vector<double> vertex_areas(const TriMesh& mesh) {
    std::vector<double> area(mesh.vertices.size(), 0.0);
    for (const Triangle& t : mesh.triangles) {
        const Vec3& a = mesh.vertices[at(t[0])];
        const double third = (mesh.vertices[at(t[1])] - a).cross(mesh.vertices[at(t[2])] - a).norm() / 6.0;
        for (int k = 0; k < 3; ++k) area[at(t[k])] += third;
    }
    return area;
}

/// Interleaves the bits of three 21-bit numbers: near in space is near in order.
std::uint64_t morton(const Vec3& p, const Vec3& low, double cell) {
    std::uint64_t code = 0;
    for (int axis = 0; axis < 3; ++axis) {
        const auto q = static_cast<std::uint64_t>(std::clamp((p[axis] - low[axis]) / cell, 0.0, 2097151.0));
        for (int bit = 0; bit < 21; ++bit) code |= ((q >> bit) & 1U) << (3 * bit + axis);
    }
    return code;
}

void sort_in_space(const std::vector<Vec3>& position, std::vector<Index>& nodes) {
    Vec3 low = position[at(nodes.front())];
    for (const Index v : nodes) low = low.cwiseMin(position[at(v)]);
    std::vector<std::pair<std::uint64_t, Index>> order;
    order.reserve(nodes.size());
    for (const Index v : nodes) order.emplace_back(morton(position[at(v)], low, 1.0), v);
    std::sort(order.begin(), order.end());
    for (std::size_t i = 0; i < nodes.size(); ++i) nodes[i] = order[i].second;
}

/// Triangles of particles: outward, in the order of `fine`'s.
std::vector<Triangle> where_three_meet(const TriMesh& fine, const Cells& cells) {
    std::vector<Triangle> out;
    for (const Triangle& t : fine.triangles) {
        const Triangle met(cells.label[at(t[0])], cells.label[at(t[1])], cells.label[at(t[2])]);
        if (met.minCoeff() >= 0 && met[0] != met[1] && met[1] != met[2] && met[2] != met[0]) out.push_back(met);
    }
    return out;
}

std::array<Index, 3> sorted(const Triangle& t) {
    std::array<Index, 3> out{t[0], t[1], t[2]};
    std::sort(out.begin(), out.end());
    return out;
}

/// Takes away the particles whose cells lie between two others alone (three meet at each end of the line those share:
/// a triangle with two sides, and a hole beside it).  False when there is none.
bool erase_enclosed(const std::vector<Triangle>& triangles, std::vector<Index>& nodes) {
    std::vector<std::set<Index>> beside(nodes.size());
    std::map<std::array<Index, 3>, int> times;
    for (const Triangle& t : triangles) {
        ++times[sorted(t)];
        for (int k = 0; k < 3; ++k) beside[at(t[k])].insert({t[(k + 1) % 3], t[(k + 2) % 3]});
    }
    std::vector<bool> touched(nodes.size(), false);
    bool any = false;
    for (const auto& [corners, met] : times) {
        if (met < 2 || touched[at(corners[0])] || touched[at(corners[1])] || touched[at(corners[2])]) continue;
        const auto enclosed =
            std::find_if(corners.begin(), corners.end(), [&](Index i) { return beside[at(i)].size() == 2; });
        if (enclosed == corners.end()) continue;
        for (const Index i : corners) touched[at(i)] = true;
        nodes[at(*enclosed)] = -1;
        any = true;
    }
    std::erase(nodes, -1);
    return any;
}

}  // namespace

std::vector<double> lumen_spacing(std::span<const double> wanted, std::span<const double> radius) {
    CATHLAB_CHECK(wanted.size() == radius.size(), "one radius a vertex");
    std::vector<double> spacing(wanted.size());
    for (std::size_t v = 0; v < wanted.size(); ++v) spacing[v] = std::min(wanted[v], 2.0 * units::pi * radius[v] / 9.5);
    return spacing;
}

WallSample sample_wall(const TriMesh& fine, const std::vector<Index>& fine_region,
                       std::span<const double> spacing_of_vertex, std::span<const double> thickness_of_region,
                       std::uint64_t seed) {
    const std::size_t n = fine.vertices.size();
    CATHLAB_CHECK(fine_region.size() == n && spacing_of_vertex.size() == n, "one region and one spacing a vertex");
    if (n == 0 || fine.empty()) throw UserError("the vessel's surface is empty: there is no wall to sample");
    for (std::size_t v = 0; v < n; ++v)
        if (!(spacing_of_vertex[v] > 0.0) || !std::isfinite(spacing_of_vertex[v]))
            throw UserError("the wall's particle spacing is " + std::to_string(spacing_of_vertex[v]) +
                            " mm; it must be above 0");
    for (const double thickness : thickness_of_region)
        if (!(thickness > 0.0) || !std::isfinite(thickness))
            throw UserError("a wall thickness is " + std::to_string(thickness) + " mm; it must be above 0");

    const auto edges = mesh_edges(fine);
    const Graph graph = make_graph(edges, fine.vertices);
    const std::vector<double> spacing = limit_gradient(graph, spacing_of_vertex, transition_slope);
    const Graph scaled = in_units(graph, spacing);
    const std::vector<double> area = vertex_areas(fine);

    std::vector<Index> nodes = scatter(scaled, dart_radius, seed);
    // A vertex without a triangle is no wall.
    std::erase_if(nodes, [&](Index v) { return !(area[at(v)] > 0.0); });
    std::vector<double> weight(n);
    for (std::size_t v = 0; v < n; ++v) weight[v] = area[v] / (spacing[v] * spacing[v] * spacing[v] * spacing[v]);
    relax(scaled, fine.vertices, weight, relaxation_rounds, nodes);
    sort_in_space(fine.vertices, nodes);
    Cells cells = nearest_source(scaled, nodes);
    while (erase_enclosed(where_three_meet(fine, cells), nodes)) cells = nearest_source(scaled, nodes);

    WallSample sample;
    const std::vector<Vec3> normals = vertex_normals(fine);
    for (const Index v : nodes) {
        const Index region = fine_region[at(v)];
        CATHLAB_CHECK(region >= 0 && at(region) < thickness_of_region.size(),
                      "a vertex names a region that is not there");
        sample.position.push_back(fine.vertices[at(v)]);
        sample.normal.push_back(normals[at(v)]);
        sample.thickness_mm.push_back(thickness_of_region[at(region)]);
        sample.region.push_back(region);
    }
    sample.area_mm2.assign(nodes.size(), 0.0);
    for (std::size_t v = 0; v < n; ++v)
        if (cells.label[v] >= 0) sample.area_mm2[at(cells.label[v])] += area[v];
    for (const auto& [a, b] : edges) {
        const Index i = cells.label[at(a)], j = cells.label[at(b)];
        if (i != j && i >= 0 && j >= 0) sample.links.emplace_back(std::minmax(i, j));
    }
    std::sort(sample.links.begin(), sample.links.end());
    sample.links.erase(std::unique(sample.links.begin(), sample.links.end()), sample.links.end());
    // A cell that is no disc (in a vessel hardly wider than its particles are apart) can meet two others twice: only
    // the first triangle at a side of an edge is taken, so that the triangles are a surface.
    std::set<std::pair<Index, Index>> taken;
    std::set<std::array<Index, 3>> corners;
    for (const Triangle& met : where_three_meet(fine, cells)) {
        const std::pair<Index, Index> sides[3] = {{met[0], met[1]}, {met[1], met[2]}, {met[2], met[0]}};
        if (corners.contains(sorted(met))) continue;
        if (std::any_of(sides, sides + 3, [&](const auto& side) { return taken.contains(side); })) continue;
        corners.insert(sorted(met));
        taken.insert(sides, sides + 3);
        sample.triangles.push_back(met);
    }
    return sample;
}

}  // namespace cathlab
