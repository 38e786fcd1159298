#include "contrast/along.h"

#include <algorithm>
#include <limits>

#include "core/check.h"

namespace cathlab {
namespace {

Index nearest_of(const CentrelineGraph& graph, std::span<const Index> nodes, const Vec3& p) {
    Index best = nodes.front();
    double least = std::numeric_limits<double>::infinity();
    for (const Index node : nodes) {
        const double off = (graph.nodes[static_cast<std::size_t>(node)].position - p).squaredNorm();
        if (off >= least) continue;
        least = off;
        best = node;
    }
    return best;
}

AlongVessel along(const CentrelineGraph& graph, const std::vector<std::vector<Index>>& neighbours, Index node,
                  const Vec3& p) {
    const Vec3& from = graph.nodes[static_cast<std::size_t>(node)].position;
    AlongVessel best{node, node, 0.0};
    double least = (p - from).squaredNorm();
    for (const Index next : neighbours[static_cast<std::size_t>(node)]) {
        // Where three or more meet, a way into another region is a branch, and where none but two meet the vessel goes
        // on.
        const bool other =
            graph.nodes[static_cast<std::size_t>(next)].region != graph.nodes[static_cast<std::size_t>(node)].region;
        if (other && neighbours[static_cast<std::size_t>(node)].size() > 2) continue;
        const Vec3 way = graph.nodes[static_cast<std::size_t>(next)].position - from;
        const double share = std::clamp((p - from).dot(way) / std::max(1e-12, way.squaredNorm()), 0.0, 1.0);
        const double off = (p - from - share * way).squaredNorm();
        if (off >= least) continue;
        least = off;
        best = {node, next, share};
    }
    return best;
}

}  // namespace

std::vector<AlongVessel> along_vessels(const CentrelineGraph& graph, std::span<const Vec3> points,
                                       std::span<const Index> region, const Workers& workers) {
    CATHLAB_CHECK(!graph.nodes.empty() && points.size() == region.size(), "one region a point, and a node at least");
    std::vector<Index> all;
    std::vector<std::vector<Index>> nodes_of;
    for (std::size_t i = 0; i < graph.nodes.size(); ++i) {
        const auto r = static_cast<std::size_t>(std::max<Index>(0, graph.nodes[i].region));
        if (nodes_of.size() <= r) nodes_of.resize(r + 1);
        nodes_of[r].push_back(static_cast<Index>(i));
        all.push_back(static_cast<Index>(i));
    }
    const auto neighbours = graph.adjacency();
    std::vector<AlongVessel> out(points.size());
    workers.for_ranges(points.size(), 256, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const auto r = static_cast<std::size_t>(std::max<Index>(0, region[i]));
            const bool known = r < nodes_of.size() && !nodes_of[r].empty();
            const Index node = nearest_of(graph, known ? nodes_of[r] : all, points[i]);
            out[i] = along(graph, neighbours, node, points[i]);
        }
    });
    return out;
}

}  // namespace cathlab
