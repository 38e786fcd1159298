#include "core/centreline.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>

namespace cathlab {

std::vector<std::vector<Index>> CentrelineGraph::adjacency() const {
    std::vector<std::vector<Index>> out(nodes.size());
    for (const auto& [a, b] : edges) {
        out[static_cast<std::size_t>(a)].push_back(b);
        out[static_cast<std::size_t>(b)].push_back(a);
    }
    for (auto& list : out) std::sort(list.begin(), list.end());
    return out;
}

Index CentrelineGraph::nearest(const Vec3& p) const {
    Index best = -1;
    double best_distance = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        const double d = (nodes[i].position - p).squaredNorm();
        if (d < best_distance) {
            best_distance = d;
            best = static_cast<Index>(i);
        }
    }
    return best;
}

std::vector<Index> CentrelineGraph::path(Index from, Index to) const {
    const auto count = static_cast<Index>(nodes.size());
    if (from < 0 || to < 0 || from >= count || to >= count) return {};
    const auto neighbours = adjacency();
    std::vector<double> distance(nodes.size(), std::numeric_limits<double>::infinity());
    std::vector<Index> previous(nodes.size(), -1);
    using Entry = std::pair<double, Index>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
    distance[static_cast<std::size_t>(from)] = 0.0;
    queue.emplace(0.0, from);
    while (!queue.empty()) {
        const auto [d, node] = queue.top();
        queue.pop();
        const auto n = static_cast<std::size_t>(node);
        if (d > distance[n]) continue;
        if (node == to) break;
        for (const Index next : neighbours[n]) {
            const auto m = static_cast<std::size_t>(next);
            const double candidate = d + std::sqrt((nodes[m].position - nodes[n].position).squaredNorm());
            if (candidate < distance[m]) {
                distance[m] = candidate;
                previous[m] = node;
                queue.emplace(candidate, next);
            }
        }
    }
    if (!std::isfinite(distance[static_cast<std::size_t>(to)])) return {};
    std::vector<Index> out;
    for (Index node = to; node != -1; node = previous[static_cast<std::size_t>(node)]) out.push_back(node);
    std::reverse(out.begin(), out.end());
    return out;
}

double CentrelineGraph::length(const std::vector<Index>& path) const {
    double sum = 0.0;
    for (std::size_t i = 1; i < path.size(); ++i)
        sum += std::sqrt(
            (nodes[static_cast<std::size_t>(path[i])].position - nodes[static_cast<std::size_t>(path[i - 1])].position)
                .squaredNorm());
    return sum;
}

}  // namespace cathlab
