#include "contact/surface_tree.h"

#include <algorithm>
#include <numeric>

namespace cathlab {
namespace {

constexpr Index leaf_size = 8;

Vec3 centroid(const Triangle& t, std::span<const Vec3> vertices) {
    return (vertices[static_cast<std::size_t>(t[0])] + vertices[static_cast<std::size_t>(t[1])] +
            vertices[static_cast<std::size_t>(t[2])]) /
           3.0;
}

}  // namespace

SurfaceTree build_surface_tree(std::span<const Triangle> triangles, std::span<const Vec3> vertices) {
    SurfaceTree tree;
    const auto count = static_cast<Index>(triangles.size());
    if (count == 0) return tree;
    std::vector<Vec3> centre(triangles.size());
    for (std::size_t t = 0; t < triangles.size(); ++t) centre[t] = centroid(triangles[t], vertices);
    tree.order.resize(triangles.size());
    std::iota(tree.order.begin(), tree.order.end(), 0);
    tree.nodes.push_back({0, count});
    // Nodes wait in `nodes` as leaves with all their triangles; each is split when its turn comes, so children follow
    // parents.
    for (std::size_t n = 0; n < tree.nodes.size(); ++n) {
        const SurfaceTree::Node node = tree.nodes[n];
        if (node.count <= leaf_size) {
            tree.leaves.push_back(static_cast<Index>(n));
            continue;
        }
        const auto begin = tree.order.begin() + node.first;
        const auto end = begin + node.count;
        Vec3 low = centre[static_cast<std::size_t>(*begin)];
        Vec3 high = low;
        for (auto i = begin; i != end; ++i) {
            low = low.cwiseMin(centre[static_cast<std::size_t>(*i)]);
            high = high.cwiseMax(centre[static_cast<std::size_t>(*i)]);
        }
        int axis = 0;
        (high - low).maxCoeff(&axis);
        const Index half = node.count / 2;
        std::nth_element(begin, begin + half, end, [&](Index a, Index b) {
            const double ca = centre[static_cast<std::size_t>(a)][axis];
            const double cb = centre[static_cast<std::size_t>(b)][axis];
            return ca < cb || (ca == cb && a < b);
        });
        // nth_element leaves each half in an order of the library's choosing.
        std::sort(begin, begin + half);
        std::sort(begin + half, end);
        const auto left = static_cast<Index>(tree.nodes.size());
        tree.nodes[n] = {left, 0};
        tree.nodes.push_back({node.first, half});
        tree.nodes.push_back({node.first + half, node.count - half});
    }
    for (const Index leaf : tree.leaves) {
        tree.leaf_vertex_start.push_back(static_cast<Index>(tree.leaf_vertex.size()));
        const SurfaceTree::Node& node = tree.nodes[static_cast<std::size_t>(leaf)];
        const auto first = static_cast<std::ptrdiff_t>(tree.leaf_vertex.size());
        for (Index i = node.first; i < node.first + node.count; ++i) {
            const Triangle& t = triangles[static_cast<std::size_t>(tree.order[static_cast<std::size_t>(i)])];
            tree.leaf_vertex.insert(tree.leaf_vertex.end(), {t[0], t[1], t[2]});
        }
        std::sort(tree.leaf_vertex.begin() + first, tree.leaf_vertex.end());
        tree.leaf_vertex.erase(std::unique(tree.leaf_vertex.begin() + first, tree.leaf_vertex.end()),
                               tree.leaf_vertex.end());
    }
    tree.leaf_vertex_start.push_back(static_cast<Index>(tree.leaf_vertex.size()));
    return tree;
}

void refit(const SurfaceTree& tree, std::span<const Vec3> vertices, std::vector<SurfaceBox>& boxes,
           const Workers& workers) {
    boxes.resize(tree.nodes.size());
    workers.for_ranges(tree.leaves.size(), 1024, [&](std::size_t begin, std::size_t end) {
        for (std::size_t l = begin; l < end; ++l) {
            const auto first = static_cast<std::size_t>(tree.leaf_vertex_start[l]);
            const auto last = static_cast<std::size_t>(tree.leaf_vertex_start[l + 1]);
            SurfaceBox box{vertices[static_cast<std::size_t>(tree.leaf_vertex[first])], Vec3::Zero()};
            box.high = box.low;
            for (std::size_t i = first + 1; i < last; ++i) {
                box.add(vertices[static_cast<std::size_t>(tree.leaf_vertex[i])]);
            }
            boxes[static_cast<std::size_t>(tree.leaves[l])] = box;
        }
    });
    for (std::size_t n = tree.nodes.size(); n-- > 0;) {
        const SurfaceTree::Node& node = tree.nodes[n];
        if (node.count > 0) continue;
        const SurfaceBox& right = boxes[static_cast<std::size_t>(node.first) + 1];
        SurfaceBox box = boxes[static_cast<std::size_t>(node.first)];
        box.add(right.low);
        box.add(right.high);
        boxes[n] = box;
    }
}

}  // namespace cathlab
