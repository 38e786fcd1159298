// Smoothing, decimation, subdivision and measures of triangle meshes.
#include <meshoptimizer.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <unordered_map>

#include "anatomy/remesh.h"
#include "core/deterministic_math.h"

namespace cathlab {
namespace {

std::vector<std::vector<Index>> neighbours_of(const TriMesh& mesh) {
    std::vector<std::vector<Index>> out(mesh.vertices.size());
    for (const Triangle& t : mesh.triangles) {
        for (int k = 0; k < 3; ++k) out[static_cast<std::size_t>(t[k])].push_back(t[(k + 1) % 3]);
    }
    return out;  // in a closed surface every neighbour comes once, by the edge that leaves
}

/// Which vertices hang together.
class Parts {
public:
    explicit Parts(std::size_t count) : root_(count) { std::iota(root_.begin(), root_.end(), 0); }
    Index of(Index v) {
        while (at(v) != v) v = at(v) = at(at(v));
        return v;
    }
    void join(Index a, Index b) { at(of(a)) = of(b); }

private:
    std::vector<Index> root_;
    Index& at(Index v) { return root_[static_cast<std::size_t>(v)]; }
};

}  // namespace

void taubin_smooth(TriMesh& mesh, int steps, double lambda, double mu) {
    const auto neighbours = neighbours_of(mesh);
    std::vector<Vec3> next(mesh.vertices.size());
    for (int step = 0; step < 2 * steps; ++step) {
        const double factor = step % 2 == 0 ? lambda : mu;
        for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
            Vec3 mean = Vec3::Zero();
            for (const Index n : neighbours[v]) mean += mesh.vertices[static_cast<std::size_t>(n)];
            next[v] = mesh.vertices[v];
            if (!neighbours[v].empty())
                next[v] += factor * (mean / static_cast<double>(neighbours[v].size()) - mesh.vertices[v]);
        }
        mesh.vertices.swap(next);
    }
}

TriMesh decimate(const TriMesh& mesh, std::size_t triangles, double error) {
    if (mesh.triangles.size() <= triangles) return mesh;
    std::vector<float> points;
    for (const Vec3& p : mesh.vertices) {
        for (int k = 0; k < 3; ++k) points.push_back(static_cast<float>(p[k]));
    }
    std::vector<unsigned> indices;
    for (const Triangle& t : mesh.triangles) {
        for (int k = 0; k < 3; ++k) indices.push_back(static_cast<unsigned>(t[k]));
    }
    std::vector<unsigned> kept(indices.size());
    const std::size_t count =
        meshopt_simplify(kept.data(), indices.data(), indices.size(), points.data(), mesh.vertices.size(),
                         3 * sizeof(float), 3 * triangles, static_cast<float>(error), 0, nullptr);
    TriMesh out;
    std::vector<Index> place(mesh.vertices.size(), -1);
    for (std::size_t i = 0; i + 2 < count; i += 3) {
        Triangle t;
        for (int k = 0; k < 3; ++k) {
            const std::size_t v = kept[i + static_cast<std::size_t>(k)];
            if (place[v] < 0) {
                place[v] = static_cast<Index>(out.vertices.size());
                out.vertices.push_back(mesh.vertices[v]);
            }
            t[k] = place[v];
        }
        out.triangles.push_back(t);
    }
    const MeshFaults faults = find_faults(out);
    return faults.sound() && faults.degenerate_triangles == 0 && !out.empty() ? out : mesh;
}

TriMesh subdivide(const TriMesh& mesh) {
    TriMesh out;
    out.vertices = mesh.vertices;
    std::unordered_map<std::uint64_t, Index> middle;
    middle.reserve(mesh.triangles.size() * 2);
    auto between = [&](Index a, Index b) {
        const auto low = static_cast<std::uint64_t>(std::min(a, b));
        const auto high = static_cast<std::uint64_t>(std::max(a, b));
        const auto [it, fresh] = middle.emplace((low << 32U) | high, static_cast<Index>(out.vertices.size()));
        if (fresh)
            out.vertices.push_back(
                0.5 * (mesh.vertices[static_cast<std::size_t>(a)] + mesh.vertices[static_cast<std::size_t>(b)]));
        return it->second;
    };
    for (const Triangle& t : mesh.triangles) {
        const Index ab = between(t[0], t[1]);
        const Index bc = between(t[1], t[2]);
        const Index ca = between(t[2], t[0]);
        out.triangles.emplace_back(t[0], ab, ca);
        out.triangles.emplace_back(t[1], bc, ab);
        out.triangles.emplace_back(t[2], ca, bc);
        out.triangles.emplace_back(ab, bc, ca);
    }
    return out;
}

TriMesh largest_part(const TriMesh& mesh) {
    Parts parts(mesh.vertices.size());
    for (const Triangle& t : mesh.triangles) {
        parts.join(t[0], t[1]);
        parts.join(t[1], t[2]);
    }
    std::vector<std::size_t> count(mesh.vertices.size(), 0);
    for (const Triangle& t : mesh.triangles) ++count[static_cast<std::size_t>(parts.of(t[0]))];
    const auto best = static_cast<Index>(std::max_element(count.begin(), count.end()) - count.begin());
    TriMesh out;
    std::vector<Index> place(mesh.vertices.size(), -1);
    for (const Triangle& t : mesh.triangles) {
        if (parts.of(t[0]) != best) continue;
        Triangle u;
        for (int k = 0; k < 3; ++k) {
            const auto v = static_cast<std::size_t>(t[k]);
            if (place[v] < 0) {
                place[v] = static_cast<Index>(out.vertices.size());
                out.vertices.push_back(mesh.vertices[v]);
            }
            u[k] = place[v];
        }
        out.triangles.push_back(u);
    }
    return out;
}

MeshQuality measure_quality(const TriMesh& mesh) {
    MeshQuality q;
    std::size_t thin = 0;
    Parts parts(mesh.vertices.size());
    std::vector<std::uint8_t> used(mesh.vertices.size(), 0);
    for (const Triangle& t : mesh.triangles) {
        double smallest = 180.0;
        for (int k = 0; k < 3; ++k) {
            const Vec3& a = mesh.vertices[static_cast<std::size_t>(t[k])];
            const Vec3 u = mesh.vertices[static_cast<std::size_t>(t[(k + 1) % 3])] - a;
            const Vec3 v = mesh.vertices[static_cast<std::size_t>(t[(k + 2) % 3])] - a;
            smallest = std::min(smallest, det::atan2(u.cross(v).norm(), u.dot(v)) * 180.0 / 3.14159265358979323846);
            parts.join(t[k], t[(k + 1) % 3]);
            used[static_cast<std::size_t>(t[k])] = 1;
        }
        q.smallest_angle_deg = std::min(q.smallest_angle_deg, smallest);
        thin += smallest < 15.0 ? 1 : 0;
    }
    long vertices = 0;
    for (std::size_t v = 0; v < used.size(); ++v) {
        vertices += used[v];
        if (used[v] != 0 && parts.of(static_cast<Index>(v)) == static_cast<Index>(v)) ++q.components;
    }
    const long faces = static_cast<long>(mesh.triangles.size());
    const long euler = vertices - faces / 2;  // closed: E = 3 F / 2
    q.genus = static_cast<int>(q.components - euler / 2);
    q.share_below_15_deg = mesh.triangles.empty() ? 0.0 : static_cast<double>(thin) / static_cast<double>(faces);
    return q;
}

}  // namespace cathlab
