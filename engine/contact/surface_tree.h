// A tree of boxes over the triangles of the lumen surface.  Its topology is built once, on the surface at rest; while
// the wall deforms only the boxes follow (refit).  A vessel bends and swells but neighbours on its wall stay
// neighbours, so the boxes stay nearly as tight as those of a new tree.
#pragma once

#include <span>
#include <vector>

#include "core/parallel.h"
#include "core/types.h"

namespace cathlab {

struct SurfaceBox {
    Vec3 low = Vec3::Zero();
    Vec3 high = Vec3::Zero();

    void add(const Vec3& p) {
        for (int a = 0; a < 3; ++a) {
            low[a] = p[a] < low[a] ? p[a] : low[a];
            high[a] = p[a] > high[a] ? p[a] : high[a];
        }
    }
    /// Squared distance from p to the box, mm2; 0 inside.
    double squared_distance(const Vec3& p) const {
        double sum = 0.0;
        for (int a = 0; a < 3; ++a) {
            const double below = low[a] - p[a];
            const double above = p[a] - high[a];
            const double d = below > above ? below : above;
            if (d > 0.0) sum += d * d;
        }
        return sum;
    }
};

/// Topology alone; const after build.  Node 0 is the root and children have higher indices than their parent.
struct SurfaceTree {
    struct Node {
        Index first = 0;  ///< leaf: first place in `order`; inner node: left child (the right one is first + 1)
        Index count = 0;  ///< triangles of a leaf; 0 = inner node
    };
    std::vector<Node> nodes;
    std::vector<Index> order;                           ///< triangle indices, leaf after leaf
    std::vector<Index> leaves;                          ///< nodes that are leaves, ascending
    std::vector<Index> parent;                          ///< of every node; -1 = none
    std::vector<std::size_t> level;                     ///< nodes of depth d are [level[d], level[d + 1])
    std::size_t vertex_count = 0;                       ///< of the whole surface
    std::vector<Index> leaf_of_node;                    ///< place in `leaves`; -1 = inner
    std::vector<Index> leaf_vertex_start, leaf_vertex;  ///< vertices of leaf l, each once: [start[l], start[l + 1])
};

/// Splits at the median centroid along the longest axis; ties by triangle index, so the same mesh gives the same tree.
SurfaceTree build_surface_tree(std::span<const Triangle> triangles, std::span<const Vec3> vertices);

/// The boxes of a tree around its triangles where they are now.
struct TreeBoxes {
    std::vector<SurfaceBox> node;   ///< one a node
    std::vector<SurfaceBox> place;  ///< one a place in `order`, so that a leaf's lie side by side
};

/// min and max are exact: any thread count gives the same bits.
void refit(const SurfaceTree& tree, std::span<const Triangle> triangles, std::span<const Vec3> vertices,
           TreeBoxes& boxes, const Workers& workers);

/// A part of the tree: some leaves and all nodes above them.
struct TreePart {
    std::vector<Index> leaves;    ///< numbers l of tree.leaves[l], ascending
    std::vector<Index> inner;     ///< nodes, descending: children before parents
    std::vector<Index> vertices;  ///< of the leaves' triangles, ascending
};

/// The leaves whose boxes come within `reach` of any of `places`, which lie near each other as they follow; of a part
/// of the tree, where one is given.
TreePart part_near(const SurfaceTree& tree, const TreeBoxes& boxes, std::span<const Vec3> places, double reach,
                   const TreePart* of = nullptr);

/// The boxes of a part; the others stay as they are.
void refit(const SurfaceTree& tree, const TreePart& part, std::span<const Triangle> triangles,
           std::span<const Vec3> vertices, TreeBoxes& boxes, const Workers& workers);

/// Above what rounding makes of a box's distance or of a triangle's.
inline constexpr double box_slack_mm2 = 1e-9;

/// The triangles of a leaf whose own boxes are within sqrt(bound()) of p.  A box is a fifth of the work of an exact
/// answer, which it spares where a wall is crumpled and a leaf's box holds half of it.
template <class Visit, class Bound>
void for_triangles_of(const SurfaceTree& tree, const SurfaceTree::Node& leaf, const TreeBoxes& boxes, const Vec3& p,
                      const Bound& bound, const Visit& visit) {
    const auto first = static_cast<std::size_t>(leaf.first), end = first + static_cast<std::size_t>(leaf.count);
    for (std::size_t i = first; i < end; ++i)
        if (boxes.place[i].squared_distance(p) <= bound() + box_slack_mm2) visit(tree.order[i]);
}

/// Calls visit(triangle) for every triangle whose box is within sqrt(bound()) of p, near leaves first; bound() is asked
/// again at every box, so visit may shrink it.
template <class Visit, class Bound>
void for_near_triangles(const SurfaceTree& tree, const TreeBoxes& boxes, const Vec3& p, const Bound& bound,
                        const Visit& visit) {
    struct Entry {
        Index node;
        double distance;
    };
    Entry stack[64];  // the tree is balanced: its depth is log2 of the triangles, below 32
    int top = 0;
    if (tree.nodes.empty()) return;
    stack[top++] = {0, boxes.node[0].squared_distance(p)};
    while (top > 0) {
        const Entry entry = stack[--top];
        if (entry.distance > bound()) continue;
        const SurfaceTree::Node& node = tree.nodes[static_cast<std::size_t>(entry.node)];
        if (node.count > 0) {
            for_triangles_of(tree, node, boxes, p, bound, visit);
            continue;
        }
        const double left = boxes.node[static_cast<std::size_t>(node.first)].squared_distance(p);
        const double right = boxes.node[static_cast<std::size_t>(node.first) + 1].squared_distance(p);
        const bool left_first = left <= right;
        stack[top++] = left_first ? Entry{node.first + 1, right} : Entry{node.first, left};
        stack[top++] = left_first ? Entry{node.first, left} : Entry{node.first + 1, right};
    }
}

/// Leaves that a few neighbouring queries share: one walk down the tree instead of one a query.  Holds every leaf whose
/// box meets the ball (centre, radius).
struct NearLeaves {
    std::vector<Index> nodes;

    void gather(const SurfaceTree& tree, const TreeBoxes& boxes, const Vec3& centre, double radius);
};

/// The triangles of those leaves whose boxes meet a ball, for one query or several about its centre.
struct NearTriangles {
    struct Entry {
        double squared_distance;  ///< of the centre to the triangle's box, mm2
        Index triangle;
    };
    std::vector<Entry> entries;

    void gather(const SurfaceTree& tree, const TreeBoxes& boxes, const NearLeaves& leaves, const Vec3& centre,
                double radius);
};

/// The same over triangles gathered about p, in their order.
template <class Visit, class Bound>
void for_near_triangles(const NearTriangles& near, const Bound& bound, const Visit& visit) {
    for (const NearTriangles::Entry& entry : near.entries)
        if (entry.squared_distance <= bound() + box_slack_mm2) visit(entry.triangle);
}

}  // namespace cathlab
