#include "anatomy/mesh_file.h"

#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <algorithm>
#include <assimp/Importer.hpp>
#include <cmath>
#include <filesystem>
#include <map>
#include <numeric>
#include <unordered_map>

namespace cathlab {
namespace {

constexpr std::uintmax_t largest_file = 512ULL << 20U;
constexpr std::size_t most_triangles = 4'000'000;

/// Vertices nearer than epsilon become one: sorted along x, each joins the first kept one in reach.
TriMesh weld(const TriMesh& mesh, double epsilon) {
    const std::size_t n = mesh.vertices.size();
    std::vector<std::size_t> order(n);
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        const double xa = mesh.vertices[a].x();
        const double xb = mesh.vertices[b].x();
        return xa != xb ? xa < xb : a < b;
    });
    const double cell = 4.0 * epsilon;
    std::unordered_map<std::uint64_t, std::vector<Index>> cells;
    auto key = [&](double x, double y, double z) {
        auto part = [&](double v) {
            return static_cast<std::uint64_t>(static_cast<std::int64_t>(std::floor(v / cell)));
        };
        return (part(x) * 0x9E3779B97F4A7C15ULL) ^ (part(y) * 0xC2B2AE3D27D4EB4FULL) ^
               (part(z) * 0x165667B19E3779F9ULL);
    };
    TriMesh out;
    std::vector<Index> place(n, -1);
    for (const std::size_t v : order) {
        const Vec3& p = mesh.vertices[v];
        for (int corner = 0; corner < 8 && place[v] < 0; ++corner) {
            const double dx = (corner & 1) != 0 ? epsilon : -epsilon;
            const double dy = (corner & 2) != 0 ? epsilon : -epsilon;
            const double dz = (corner & 4) != 0 ? epsilon : -epsilon;
            const auto it = cells.find(key(p.x() + dx, p.y() + dy, p.z() + dz));
            if (it == cells.end()) continue;
            for (const Index k : it->second) {
                if ((out.vertices[static_cast<std::size_t>(k)] - p).norm() <= epsilon) place[v] = k;
            }
        }
        if (place[v] >= 0) continue;
        place[v] = static_cast<Index>(out.vertices.size());
        cells[key(p.x(), p.y(), p.z())].push_back(place[v]);
        out.vertices.push_back(p);
    }
    for (const Triangle& t : mesh.triangles) {
        Triangle u;
        for (int k = 0; k < 3; ++k) u[k] = place[static_cast<std::size_t>(t[k])];
        if (u[0] != u[1] && u[1] != u[2] && u[2] != u[0]) out.triangles.push_back(u);
    }
    return out;
}

std::uint64_t edge_key(Index a, Index b) {
    const auto low = static_cast<std::uint64_t>(std::min(a, b));
    const auto high = static_cast<std::uint64_t>(std::max(a, b));
    return (low << 32U) | high;
}

/// Vertices whose triangles form more than one fan: two cones that touch at their tips.
std::size_t pinched_vertices(const TriMesh& mesh, Vec3& first) {
    std::vector<std::vector<std::pair<Index, Index>>> fans(mesh.vertices.size());
    for (const Triangle& t : mesh.triangles) {
        for (int k = 0; k < 3; ++k) fans[static_cast<std::size_t>(t[k])].emplace_back(t[(k + 1) % 3], t[(k + 2) % 3]);
    }
    std::size_t count = 0;
    for (std::size_t v = 0; v < fans.size(); ++v) {
        if (fans[v].empty()) continue;
        std::map<Index, Index> next(fans[v].begin(), fans[v].end());
        std::size_t steps = 0;
        const Index start = fans[v].front().first;
        Index at = start;
        do {
            const auto it = next.find(at);
            if (it == next.end()) break;
            at = it->second;
            ++steps;
        } while (at != start && steps <= fans[v].size());
        if (steps == fans[v].size()) continue;
        if (count++ == 0) first = mesh.vertices[v];
    }
    return count;
}

std::string at_place(const Vec3& p_mm, double unit_mm) {
    char text[120];
    const Vec3 p = p_mm / unit_mm;
    std::snprintf(text, sizeof text, "(%.6g, %.6g, %.6g)", p.x(), p.y(), p.z());
    return text;
}

}  // namespace

double unit_in_mm(const std::string& unit) {
    return unit == "m" ? 1000.0 : unit == "cm" ? 10.0 : 1.0;
}

TriMesh load_mesh(const std::string& path, const std::string& unit, const SourcePlace& where) {
    std::error_code error;
    if (!std::filesystem::is_regular_file(path, error)) throw UserError(where, "there is no mesh file '" + path + "'");
    const std::uintmax_t size = std::filesystem::file_size(path, error);
    if (error) throw UserError(where, "the mesh file '" + path + "' cannot be read: " + error.message());
    if (size == 0) throw UserError(where, "the mesh file '" + path + "' is empty");
    if (size > largest_file)
        throw UserError(
            where, "the mesh file '" + path + "' has " + std::to_string(size >> 20U) + " MB; at most 512 MB are read");
    std::string ending = std::filesystem::path(path).extension().string();
    std::transform(ending.begin(), ending.end(), ending.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    const std::vector<std::string> known = {".obj", ".stl", ".ply", ".glb", ".gltf"};
    if (std::find(known.begin(), known.end(), ending) == known.end())
        throw UserError(where, "the mesh file '" + path + "' is none of OBJ, STL, PLY, GLB, glTF by its name");

    Assimp::Importer importer;
    // Normals, colours and texture coordinates would keep equal vertices apart.
    importer.SetPropertyInteger(AI_CONFIG_PP_RVC_FLAGS, aiComponent_NORMALS | aiComponent_TANGENTS_AND_BITANGENTS |
                                                            aiComponent_COLORS | aiComponent_TEXCOORDS |
                                                            aiComponent_BONEWEIGHTS | aiComponent_ANIMATIONS |
                                                            aiComponent_TEXTURES | aiComponent_LIGHTS |
                                                            aiComponent_CAMERAS | aiComponent_MATERIALS);
    const aiScene* scene = nullptr;
    std::string reason;
    try {
        scene =
            importer.ReadFile(path, aiProcess_RemoveComponent | aiProcess_Triangulate | aiProcess_PreTransformVertices);
        reason = importer.GetErrorString();
    } catch (const std::exception& e) {
        reason = e.what();
    }
    if (scene == nullptr) throw UserError(where, "the mesh file '" + path + "' cannot be read: " + reason);
    TriMesh soup;
    const double scale = unit_in_mm(unit);
    for (unsigned m = 0; m < scene->mNumMeshes; ++m) {
        const aiMesh& part = *scene->mMeshes[m];
        const std::size_t first = soup.vertices.size();
        if (first + part.mNumVertices > 3 * most_triangles || soup.triangles.size() + part.mNumFaces > most_triangles)
            throw UserError(
                where, "the mesh file '" + path + "' has more than " + std::to_string(most_triangles) + " triangles");
        for (unsigned v = 0; v < part.mNumVertices; ++v) {
            const aiVector3D& p = part.mVertices[v];
            soup.vertices.emplace_back(scale * static_cast<double>(p.x), scale * static_cast<double>(p.y),
                                       scale * static_cast<double>(p.z));
        }
        for (unsigned f = 0; f < part.mNumFaces; ++f) {
            const aiFace& face = part.mFaces[f];
            if (face.mNumIndices != 3) continue;  // points and lines
            Triangle t;
            bool inside = true;
            for (int k = 0; k < 3; ++k) {
                inside = inside && face.mIndices[k] < part.mNumVertices;
                t[k] = static_cast<Index>(first + face.mIndices[k]);
            }
            if (!inside)
                throw UserError(where, "the mesh file '" + path + "' has a triangle with a vertex that does not exist");
            soup.triangles.push_back(t);
        }
    }
    if (soup.triangles.empty()) throw UserError(where, "the mesh file '" + path + "' has no triangles");
    Vec3 low = Vec3::Constant(1e300);
    Vec3 high = Vec3::Constant(-1e300);
    std::size_t bad = 0;
    for (const Vec3& p : soup.vertices) {
        if (!(p.cwiseAbs().maxCoeff() < 1e7) || !p.allFinite()) {
            ++bad;
            continue;
        }
        low = low.cwiseMin(p);
        high = high.cwiseMax(p);
    }
    if (bad > 0)
        throw UserError(where, "the mesh file '" + path + "' has " + std::to_string(bad) +
                                   " vertices whose coordinates are not finite numbers (or beyond 10 km)");
    const double extent = (high - low).norm();
    if (!(extent > 0.0)) throw UserError(where, "all vertices of the mesh file '" + path + "' are one point");
    TriMesh mesh = weld(soup, 1e-6 * extent);
    if (mesh.triangles.empty()) throw UserError(where, "all triangles of the mesh file '" + path + "' are degenerate");
    return mesh;
}

bool orient_outward(TriMesh& mesh) {
    std::unordered_map<std::uint64_t, std::array<Index, 2>> wings;
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        for (int k = 0; k < 3; ++k) {
            const auto key = edge_key(mesh.triangles[i][k], mesh.triangles[i][(k + 1) % 3]);
            const auto [it, fresh] = wings.try_emplace(key, std::array<Index, 2>{-1, -1});
            it->second[it->second[0] < 0 ? 0 : 1] = static_cast<Index>(i);
        }
    }
    auto runs = [&](Index t, Index a, Index b) {
        const Triangle& tri = mesh.triangles[static_cast<std::size_t>(t)];
        for (int k = 0; k < 3; ++k) {
            if (tri[k] == a && tri[(k + 1) % 3] == b) return true;
        }
        return false;
    };
    bool turned = false;
    std::vector<std::uint8_t> seen(mesh.triangles.size(), 0);
    for (std::size_t start = 0; start < mesh.triangles.size(); ++start) {
        if (seen[start] != 0) continue;
        std::vector<Index> part = {static_cast<Index>(start)};
        seen[start] = 1;
        for (std::size_t i = 0; i < part.size(); ++i) {
            const Index here = part[i];
            const Triangle t = mesh.triangles[static_cast<std::size_t>(here)];
            for (int k = 0; k < 3; ++k) {
                const auto& pair = wings.at(edge_key(t[k], t[(k + 1) % 3]));
                const Index other = pair[0] == here ? pair[1] : pair[0];
                if (other < 0 || seen[static_cast<std::size_t>(other)] != 0) continue;
                seen[static_cast<std::size_t>(other)] = 1;
                if (runs(other, t[k], t[(k + 1) % 3])) {
                    std::swap(mesh.triangles[static_cast<std::size_t>(other)][1],
                              mesh.triangles[static_cast<std::size_t>(other)][2]);
                    turned = true;
                }
                part.push_back(other);
            }
        }
        double volume = 0.0;
        for (const Index i : part) {
            const Triangle& t = mesh.triangles[static_cast<std::size_t>(i)];
            volume += mesh.vertices[static_cast<std::size_t>(t[0])].dot(
                mesh.vertices[static_cast<std::size_t>(t[1])].cross(mesh.vertices[static_cast<std::size_t>(t[2])]));
        }
        if (volume < 0.0) {
            turned = true;
            for (const Index i : part)
                std::swap(mesh.triangles[static_cast<std::size_t>(i)][1],
                          mesh.triangles[static_cast<std::size_t>(i)][2]);
        }
    }
    return turned;
}

void require_closed(const TriMesh& mesh, const std::string& path, double unit_mm, const SourcePlace& where) {
    const MeshFaults faults = find_faults(mesh);
    if (!faults.sound()) {
        std::string found;
        if (faults.open_edges > 0) found = std::to_string(faults.open_edges) + " open edges (with one triangle)";
        if (faults.non_manifold_edges > 0)
            found += (found.empty() ? "" : " and ") + std::to_string(faults.non_manifold_edges) +
                     " non-manifold edges (more than two triangles, or two that face opposite ways)";
        throw UserError(where, "the mesh file '" + path + "' is no closed surface: it has " + found +
                                   ", the first at " + at_place(faults.first_place, unit_mm) +
                                   " in the file's coordinates; a lumen must be closed and manifold");
    }
    Vec3 first = Vec3::Zero();
    if (const std::size_t pinched = pinched_vertices(mesh, first); pinched > 0)
        throw UserError(where, "the mesh file '" + path + "' has " + std::to_string(pinched) +
                                   " vertices where two surfaces touch in a point, the first at " +
                                   at_place(first, unit_mm) + " in the file's coordinates; a lumen must be manifold");
}

}  // namespace cathlab
