#include "anatomy/voxel_surface.h"

#include <openvdb/openvdb.h>
#include <openvdb/tools/Interpolation.h>
#include <openvdb/tools/MeshToVolume.h>
#include <openvdb/tools/SignedFloodFill.h>
#include <openvdb/tools/VolumeToMesh.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "core/check.h"

namespace cathlab {
namespace {

constexpr double band_voxels = 3.0;

/// OpenVDB's tools use the task scheduler of whoever calls them: give them as many threads as the caller allows.
template <class Body>
void in_arena(const Workers& workers, Body&& body) {
    tbb::task_arena arena(workers.threads());
    arena.execute([&] { tbb::this_task_arena::isolate(body); });
}

/// Vertices sorted by place, triangles by their vertices: one order whatever thread found which part first.
TriMesh sorted(const TriMesh& mesh) {
    const std::size_t n = mesh.vertices.size();
    std::vector<Index> order(n);
    std::iota(order.begin(), order.end(), 0);
    std::sort(order.begin(), order.end(), [&](Index a, Index b) {
        const Vec3& p = mesh.vertices[static_cast<std::size_t>(a)];
        const Vec3& q = mesh.vertices[static_cast<std::size_t>(b)];
        if (p.z() != q.z()) return p.z() < q.z();
        if (p.y() != q.y()) return p.y() < q.y();
        return p.x() != q.x() ? p.x() < q.x() : a < b;
    });
    std::vector<Index> place(n);
    TriMesh out;
    out.vertices.resize(n);
    for (std::size_t i = 0; i < n; ++i) {
        place[static_cast<std::size_t>(order[i])] = static_cast<Index>(i);
        out.vertices[i] = mesh.vertices[static_cast<std::size_t>(order[i])];
    }
    out.triangles.reserve(mesh.triangles.size());
    for (const Triangle& t : mesh.triangles) {
        Triangle u;
        for (int k = 0; k < 3; ++k) u[k] = place[static_cast<std::size_t>(t[k])];
        while (u[0] > u[1] || u[0] > u[2]) u = Triangle(u[1], u[2], u[0]);
        out.triangles.push_back(u);
    }
    std::sort(out.triangles.begin(), out.triangles.end(), [](const Triangle& a, const Triangle& b) {
        return std::lexicographical_compare(a.data(), a.data() + 3, b.data(), b.data() + 3);
    });
    return out;
}

TriMesh mesh_of_grid(const openvdb::FloatGrid& grid, double level, const Workers& workers) {
    std::vector<openvdb::Vec3s> points;
    std::vector<openvdb::Vec3I> triangles;
    std::vector<openvdb::Vec4I> quads;
    in_arena(workers, [&] { openvdb::tools::volumeToMesh(grid, points, triangles, quads, level, 0.0); });
    TriMesh mesh;
    for (const openvdb::Vec3s& p : points) mesh.vertices.emplace_back(p.x(), p.y(), p.z());
    auto add = [&](unsigned a, unsigned b, unsigned c) {
        mesh.triangles.emplace_back(static_cast<Index>(a), static_cast<Index>(b), static_cast<Index>(c));
    };
    for (const openvdb::Vec3I& t : triangles) add(t[0], t[1], t[2]);
    for (const openvdb::Vec4I& q : quads) {  // along the shorter diagonal
        const double across = (mesh.vertices[q[0]] - mesh.vertices[q[2]]).squaredNorm();
        const double other = (mesh.vertices[q[1]] - mesh.vertices[q[3]]).squaredNorm();
        if (across <= other) {
            add(q[0], q[1], q[2]);
            add(q[0], q[2], q[3]);
        } else {
            add(q[1], q[2], q[3]);
            add(q[1], q[3], q[0]);
        }
    }
    if (signed_volume(mesh) < 0.0) {
        for (Triangle& t : mesh.triangles) std::swap(t[1], t[2]);
    }
    return sorted(mesh);
}

}  // namespace

TriMesh mesh_level_set(const ScalarField& field, const Vec3& low, const Vec3& high, double voxel_mm,
                       const Workers& workers) {
    openvdb::initialize();
    using Leaf = openvdb::FloatTree::LeafNodeType;
    constexpr int side = Leaf::DIM;
    const double block = side * voxel_mm;
    const double band = band_voxels * voxel_mm;
    const std::array<std::int32_t, 3> first = {static_cast<std::int32_t>(std::floor(low.x() / block)),
                                               static_cast<std::int32_t>(std::floor(low.y() / block)),
                                               static_cast<std::int32_t>(std::floor(low.z() / block))};
    std::array<std::size_t, 3> count{};
    for (std::size_t k = 0; k < 3; ++k)
        count[k] = static_cast<std::size_t>(
            std::max(1.0, std::floor(high[static_cast<Eigen::Index>(k)] / block) - first[k] + 1.0));
    const std::size_t total = count[0] * count[1] * count[2];
    auto origin = [&](std::size_t b) {
        return openvdb::Coord(side * (first[0] + static_cast<std::int32_t>(b % count[0])),
                              side * (first[1] + static_cast<std::int32_t>(b / count[0] % count[1])),
                              side * (first[2] + static_cast<std::int32_t>(b / (count[0] * count[1]))));
    };
    auto place = [&](const openvdb::Coord& c) -> Vec3 { return voxel_mm * Vec3(c.x(), c.y(), c.z()); };
    std::vector<std::uint8_t> wanted(total, 0);
    workers.for_ranges(total, 4096, [&](std::size_t begin, std::size_t end) {
        for (std::size_t b = begin; b < end; ++b) {
            const Vec3 middle = place(origin(b)) + Vec3::Constant(0.5 * (block - voxel_mm));
            wanted[b] = std::fabs(field(middle)) < 0.87 * block + band ? 1 : 0;
        }
    });
    std::vector<std::size_t> blocks;
    for (std::size_t b = 0; b < total; ++b) {
        if (wanted[b] != 0) blocks.push_back(b);
    }
    std::vector<std::unique_ptr<Leaf>> leaves(blocks.size());
    workers.for_ranges(blocks.size(), 64, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            auto leaf = std::make_unique<Leaf>(origin(blocks[i]), static_cast<float>(band), false);
            for (openvdb::Index v = 0; v < Leaf::SIZE; ++v) {
                const double d = field(place(leaf->offsetToGlobalCoord(v)));
                leaf->setValueOnly(v, static_cast<float>(std::clamp(d, -band, band)));
                if (std::fabs(d) < band) leaf->setValueOn(v);
            }
            leaves[i] = std::move(leaf);
        }
    });
    auto grid = openvdb::FloatGrid::create(static_cast<float>(band));
    grid->setTransform(openvdb::math::Transform::createLinearTransform(voxel_mm));
    grid->setGridClass(openvdb::GRID_LEVEL_SET);
    for (auto& leaf : leaves) {
        if (!leaf->isEmpty()) grid->tree().addLeaf(leaf.release());
    }
    openvdb::tools::signedFloodFill(grid->tree(), false);
    return mesh_of_grid(*grid, 0.0, workers);
}

struct DistanceGrid::Grid {
    openvdb::FloatGrid::Ptr grid;
};

DistanceGrid::DistanceGrid(const TriMesh& mesh, double voxel_mm, double inside_mm, double outside_mm,
                           const Workers& workers)
    : voxel_(voxel_mm) {
    openvdb::initialize();
    std::vector<openvdb::Vec3s> points;
    std::vector<openvdb::Vec3I> triangles;
    for (const Vec3& p : mesh.vertices) points.emplace_back(p.x(), p.y(), p.z());
    for (const Triangle& t : mesh.triangles)
        triangles.emplace_back(static_cast<unsigned>(t[0]), static_cast<unsigned>(t[1]), static_cast<unsigned>(t[2]));
    auto grid = std::make_shared<Grid>();
    in_arena(workers, [&] {
        grid->grid = openvdb::tools::meshToSignedDistanceField<openvdb::FloatGrid>(
            *openvdb::math::Transform::createLinearTransform(voxel_mm), points, triangles, {},
            static_cast<float>(std::max(band_voxels, outside_mm / voxel_mm)),
            static_cast<float>(std::max(band_voxels, inside_mm / voxel_mm)));
    });
    grid_ = grid;
}

double DistanceGrid::value(const Vec3& p) const {
    using Sampler = openvdb::tools::GridSampler<openvdb::FloatGrid::ConstAccessor, openvdb::tools::BoxSampler>;
    const openvdb::FloatGrid::ConstAccessor accessor(grid_->grid->getConstAccessor());
    const Sampler sampler(accessor, grid_->grid->transform());
    return static_cast<double>(sampler.wsSample(openvdb::Vec3d(p.x(), p.y(), p.z())));
}

Vec3 DistanceGrid::gradient(const Vec3& p) const {
    Vec3 g;
    const double h = 0.5 * voxel_;
    for (int k = 0; k < 3; ++k) {
        Vec3 d = Vec3::Zero();
        d[k] = h;
        g[k] = (value(p + d) - value(p - d)) / (2.0 * h);
    }
    return g;
}

TriMesh DistanceGrid::surface(double level_mm, const Workers& workers) const {
    return mesh_of_grid(*grid_->grid, level_mm, workers);
}

}  // namespace cathlab
