#include "contact/surface_tree.h"

#include <algorithm>
#include <cstdint>
#include <numeric>

namespace cathlab {
namespace {

constexpr Index leaf_size = 4;
constexpr std::size_t leaf_grain = 256;
constexpr std::size_t node_grain = 512;
constexpr double ball_mm = 5.0;  // places that are asked for at once

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
    tree.parent.push_back(-1);
    tree.level.push_back(0);
    // Nodes wait in `nodes` as leaves with all their triangles; each is split when its turn comes, so children follow
    // parents.
    for (std::size_t n = 0; n < tree.nodes.size(); ++n) {
        if (n == tree.level.back()) tree.level.push_back(tree.nodes.size());
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
        tree.parent.insert(tree.parent.end(), 2, static_cast<Index>(n));
        tree.nodes.push_back({node.first, half});
        tree.nodes.push_back({node.first + half, node.count - half});
    }
    tree.leaf_of_node.assign(tree.nodes.size(), -1);
    for (const Index leaf : tree.leaves) {
        tree.leaf_of_node[static_cast<std::size_t>(leaf)] = static_cast<Index>(tree.leaf_vertex_start.size());
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
    tree.vertex_count = vertices.size();
    return tree;
}

namespace {

void fit_leaf(const SurfaceTree& tree, std::size_t leaf, std::span<const Triangle> triangles,
              std::span<const Vec3> vertices, TreeBoxes& boxes) {
    const auto n = static_cast<std::size_t>(tree.leaves[leaf]);
    const auto first = static_cast<std::size_t>(tree.nodes[n].first);
    const auto end = first + static_cast<std::size_t>(tree.nodes[n].count);
    for (std::size_t i = first; i < end; ++i) {
        const Triangle& t = triangles[static_cast<std::size_t>(tree.order[i])];
        SurfaceBox& box = boxes.place[i];
        box.low = box.high = vertices[static_cast<std::size_t>(t[0])];
        box.add(vertices[static_cast<std::size_t>(t[1])]);
        box.add(vertices[static_cast<std::size_t>(t[2])]);
    }
    SurfaceBox& whole = boxes.node[n];
    whole = boxes.place[first];
    for (std::size_t i = first + 1; i < end; ++i) {
        whole.add(boxes.place[i].low);
        whole.add(boxes.place[i].high);
    }
}

SurfaceBox inner_box(const SurfaceTree& tree, std::size_t node, const std::vector<SurfaceBox>& boxes) {
    const auto left = static_cast<std::size_t>(tree.nodes[node].first);
    SurfaceBox box = boxes[left];
    box.add(boxes[left + 1].low);
    box.add(boxes[left + 1].high);
    return box;
}

}  // namespace

void refit(const SurfaceTree& tree, std::span<const Triangle> triangles, std::span<const Vec3> vertices,
           TreeBoxes& boxes, const Workers& workers) {
    boxes.node.resize(tree.nodes.size());
    boxes.place.resize(tree.order.size());
    workers.for_ranges(tree.leaves.size(), leaf_grain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t l = begin; l < end; ++l) fit_leaf(tree, l, triangles, vertices, boxes);
    });
    for (std::size_t depth = tree.level.size() - 1; depth-- > 0;) {
        const std::size_t first = tree.level[depth];
        workers.for_ranges(tree.level[depth + 1] - first, node_grain, [&](std::size_t begin, std::size_t end) {
            for (std::size_t n = first + begin; n < first + end; ++n)
                if (tree.nodes[n].count == 0) boxes.node[n] = inner_box(tree, n, boxes.node);
        });
    }
}

void refit(const SurfaceTree& tree, const TreePart& part, std::span<const Triangle> triangles,
           std::span<const Vec3> vertices, TreeBoxes& boxes, const Workers& workers) {
    workers.for_ranges(part.leaves.size(), leaf_grain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k)
            fit_leaf(tree, static_cast<std::size_t>(part.leaves[k]), triangles, vertices, boxes);
    });
    for (const Index n : part.inner) {
        const auto node = static_cast<std::size_t>(n);
        boxes.node[node] = inner_box(tree, node, boxes.node);
    }
}

namespace {

/// Nodes above some leaves (node numbers, ascending), descending.  Nodes are numbered level by level, so the parents of
/// nodes that descend do so too.
std::vector<Index> nodes_above(const SurfaceTree& tree, const std::vector<Index>& leaf_nodes) {
    std::vector<Index> above;
    std::size_t next = 0;  // of `above`: whose parent comes
    for (auto leaf = leaf_nodes.rbegin();;) {
        Index node = -1;
        if (leaf != leaf_nodes.rend() && (next == above.size() || *leaf > above[next])) {
            node = *leaf++;
        } else if (next < above.size()) {
            node = above[next++];
        } else {
            return above;
        }
        const Index parent = tree.parent[static_cast<std::size_t>(node)];
        if (parent >= 0 && (above.empty() || above.back() != parent)) above.push_back(parent);
    }
}

}  // namespace

TreePart part_near(const SurfaceTree& tree, const TreeBoxes& boxes, std::span<const Vec3> places, double reach,
                   const TreePart* of) {
    std::vector<std::uint8_t> wanted(tree.leaves.size(), 0);
    NearLeaves near;
    for (std::size_t i = 0; i < places.size();) {
        const Vec3& centre = places[i];
        double radius = 0.0;
        for (; i < places.size() && (places[i] - centre).squaredNorm() <= ball_mm * ball_mm; ++i)
            radius = std::max(radius, (places[i] - centre).norm());
        near.gather(tree, boxes, centre, radius + reach);
        for (const Index n : near.nodes)
            wanted[static_cast<std::size_t>(tree.leaf_of_node[static_cast<std::size_t>(n)])] = 1;
    }
    TreePart part;
    std::vector<Index> leaf_nodes;
    std::vector<std::uint8_t> met(tree.vertex_count, 0);
    const std::size_t leaves = of ? of->leaves.size() : tree.leaves.size();
    for (std::size_t k = 0; k < leaves; ++k) {
        const std::size_t l = of ? static_cast<std::size_t>(of->leaves[k]) : k;
        if (!wanted[l]) continue;
        part.leaves.push_back(static_cast<Index>(l));
        leaf_nodes.push_back(tree.leaves[l]);
        for (Index v = tree.leaf_vertex_start[l]; v < tree.leaf_vertex_start[l + 1]; ++v)
            met[static_cast<std::size_t>(tree.leaf_vertex[static_cast<std::size_t>(v)])] = 1;
    }
    for (std::size_t v = 0; v < met.size(); ++v)
        if (met[v]) part.vertices.push_back(static_cast<Index>(v));
    part.inner = nodes_above(tree, leaf_nodes);
    return part;
}

void NearLeaves::gather(const SurfaceTree& tree, const TreeBoxes& boxes, const Vec3& centre, double radius) {
    nodes.clear();
    if (tree.nodes.empty()) return;
    const double bound = radius * radius;
    Index stack[64];  // as deep as the tree
    int top = 0;
    stack[top++] = 0;
    while (top > 0) {
        const Index n = stack[--top];
        if (boxes.node[static_cast<std::size_t>(n)].squared_distance(centre) > bound) continue;
        const SurfaceTree::Node& node = tree.nodes[static_cast<std::size_t>(n)];
        if (node.count > 0) {
            nodes.push_back(n);
            continue;
        }
        stack[top++] = node.first + 1;
        stack[top++] = node.first;
    }
}

void NearTriangles::gather(const SurfaceTree& tree, const TreeBoxes& boxes, const NearLeaves& leaves,
                           const Vec3& centre, double radius) {
    entries.clear();
    const double bound = radius * radius + box_slack_mm2;
    for (const Index leaf : leaves.nodes) {
        if (boxes.node[static_cast<std::size_t>(leaf)].squared_distance(centre) > bound) continue;
        const SurfaceTree::Node& node = tree.nodes[static_cast<std::size_t>(leaf)];
        const auto first = static_cast<std::size_t>(node.first), end = first + static_cast<std::size_t>(node.count);
        for (std::size_t i = first; i < end; ++i) {
            const double distance = boxes.place[i].squared_distance(centre);
            if (distance <= bound) entries.push_back({distance, tree.order[i]});
        }
    }
}

}  // namespace cathlab
