#include "core/mesh.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace cathlab {

MeshFaults find_faults(const TriMesh& mesh) {
    struct Half {
        std::uint64_t key;
        bool forward;
    };
    std::vector<Half> halves;
    halves.reserve(mesh.triangles.size() * 3);
    MeshFaults faults;
    for (const Triangle& t : mesh.triangles) {
        if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) ++faults.degenerate_triangles;
        for (int e = 0; e < 3; ++e) {
            const auto a = static_cast<std::uint64_t>(t[e]);
            const auto b = static_cast<std::uint64_t>(t[(e + 1) % 3]);
            halves.push_back({(std::min(a, b) << 32U) | std::max(a, b), a < b});
        }
    }
    std::sort(halves.begin(), halves.end(),
              [](const Half& a, const Half& b) { return a.key != b.key ? a.key < b.key : a.forward < b.forward; });
    bool first = true;
    for (std::size_t i = 0; i < halves.size();) {
        std::size_t j = i;
        std::size_t forward = 0;
        for (; j < halves.size() && halves[j].key == halves[i].key; ++j) forward += halves[j].forward ? 1 : 0;
        const std::size_t count = j - i;
        const bool open = count == 1;
        const bool non_manifold = count > 2 || (count == 2 && forward != 1);
        faults.open_edges += open ? 1 : 0;
        faults.non_manifold_edges += non_manifold ? 1 : 0;
        if (first && (open || non_manifold)) {
            const auto a = static_cast<std::size_t>(halves[i].key >> 32U);
            const auto b = static_cast<std::size_t>(halves[i].key & 0xFFFFFFFFULL);
            faults.first_place = 0.5 * (mesh.vertices[a] + mesh.vertices[b]);
            first = false;
        }
        i = j;
    }
    return faults;
}

namespace {
const Vec3& corner(const TriMesh& mesh, const Triangle& t, int k) {
    return mesh.vertices[static_cast<std::size_t>(t[k])];
}
}  // namespace

double signed_volume(const TriMesh& mesh) {
    double sum = 0.0;
    for (const Triangle& t : mesh.triangles)
        sum += corner(mesh, t, 0).dot(corner(mesh, t, 1).cross(corner(mesh, t, 2)));
    return sum / 6.0;
}

double surface_area(const TriMesh& mesh) {
    double sum = 0.0;
    for (const Triangle& t : mesh.triangles) {
        const Vec3 n = (corner(mesh, t, 1) - corner(mesh, t, 0)).cross(corner(mesh, t, 2) - corner(mesh, t, 0));
        sum += 0.5 * std::sqrt(n.squaredNorm());
    }
    return sum;
}

std::vector<Vec3> vertex_normals(const TriMesh& mesh) {
    std::vector<Vec3> normals(mesh.vertices.size(), Vec3::Zero());
    for (const Triangle& t : mesh.triangles) {
        const Vec3 n = (corner(mesh, t, 1) - corner(mesh, t, 0)).cross(corner(mesh, t, 2) - corner(mesh, t, 0));
        for (int k = 0; k < 3; ++k) normals[static_cast<std::size_t>(t[k])] += n;
    }
    for (Vec3& n : normals) {
        const double length = std::sqrt(n.squaredNorm());
        if (length > 0.0) n /= length;
    }
    return normals;
}

}  // namespace cathlab
