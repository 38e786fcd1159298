#include "softbody/geodesic.h"

#include <algorithm>
#include <functional>
#include <limits>
#include <numeric>
#include <queue>

#include "core/check.h"
#include "core/random.h"

namespace cathlab {

namespace {

constexpr double far_away = std::numeric_limits<double>::infinity();
using Entry = std::pair<double, Index>;
using Queue = std::priority_queue<Entry, std::vector<Entry>, std::greater<>>;

std::size_t at(Index i) {
    return static_cast<std::size_t>(i);
}

/// Settles every node from the entries in the queue; on_better(from, to) is told of each improvement.
template <class OnBetter>
void settle(const Graph& graph, std::vector<double>& distance, Queue& queue, double slope, OnBetter on_better) {
    while (!queue.empty()) {
        const auto [d, v] = queue.top();
        queue.pop();
        if (d > distance[at(v)]) continue;
        for (Index e = graph.start[at(v)]; e < graph.start[at(v) + 1]; ++e) {
            const Index to = graph.neighbour[at(e)];
            const double next = d + slope * graph.length[at(e)];
            if (next < distance[at(to)]) {
                distance[at(to)] = next;
                on_better(v, to);
                queue.emplace(next, to);
            }
        }
    }
}

}  // namespace

Graph make_graph(std::span<const std::pair<Index, Index>> edges, std::span<const Vec3> position) {
    std::vector<std::pair<Index, Index>> both;
    both.reserve(2 * edges.size());
    for (const auto& [a, b] : edges) {
        CATHLAB_CHECK(a >= 0 && b >= 0 && at(a) < position.size() && at(b) < position.size(), "edge out of range");
        if (a == b) continue;
        both.emplace_back(a, b);
        both.emplace_back(b, a);
    }
    std::sort(both.begin(), both.end());
    both.erase(std::unique(both.begin(), both.end()), both.end());
    Graph graph;
    graph.start.assign(position.size() + 1, 0);
    graph.neighbour.reserve(both.size());
    graph.length.reserve(both.size());
    for (const auto& [a, b] : both) {
        ++graph.start[at(a) + 1];
        graph.neighbour.push_back(b);
        // Two nodes in one place are still two steps apart for a search that counts on positive lengths.
        graph.length.push_back(std::max((position[at(a)] - position[at(b)]).norm(), 1e-12));
    }
    std::partial_sum(graph.start.begin(), graph.start.end(), graph.start.begin());
    return graph;
}

Graph in_units(const Graph& graph, std::span<const double> unit) {
    CATHLAB_CHECK(unit.size() == graph.size(), "one unit a node");
    Graph scaled = graph;
    for (std::size_t v = 0; v < graph.size(); ++v)
        for (Index e = graph.start[v]; e < graph.start[v + 1]; ++e)
            scaled.length[at(e)] *= 2.0 / (unit[v] + unit[at(graph.neighbour[at(e)])]);
    return scaled;
}

Reach::Reach(const Graph& graph) : graph_(graph), distance_(graph.size(), far_away) {}

const std::vector<Reach::Hit>& Reach::within(Index source, double radius, std::size_t most) {
    hits_.clear();
    heap_.clear();
    heap_.emplace_back(0.0, source);
    distance_[at(source)] = 0.0;
    touched_.push_back(source);
    while (!heap_.empty() && hits_.size() < most) {
        std::pop_heap(heap_.begin(), heap_.end(), std::greater<>());
        const auto [d, v] = heap_.back();
        heap_.pop_back();
        if (d > distance_[at(v)]) continue;
        hits_.push_back({v, d});
        for (Index e = graph_.start[at(v)]; e < graph_.start[at(v) + 1]; ++e) {
            const Index to = graph_.neighbour[at(e)];
            const double next = d + graph_.length[at(e)];
            if (next > radius || next >= distance_[at(to)]) continue;
            distance_[at(to)] = next;
            touched_.push_back(to);
            heap_.emplace_back(next, to);
            std::push_heap(heap_.begin(), heap_.end(), std::greater<>());
        }
    }
    for (const Index v : touched_) distance_[at(v)] = far_away;
    touched_.clear();
    return hits_;
}

Cells nearest_source(const Graph& graph, std::span<const Index> sources) {
    Cells cells{std::vector<Index>(graph.size(), -1), std::vector<double>(graph.size(), far_away)};
    Queue queue;
    for (std::size_t s = 0; s < sources.size(); ++s) {
        cells.label[at(sources[s])] = static_cast<Index>(s);
        cells.distance[at(sources[s])] = 0.0;
        queue.emplace(0.0, sources[s]);
    }
    settle(graph, cells.distance, queue, 1.0,
           [&](Index from, Index to) { cells.label[at(to)] = cells.label[at(from)]; });
    return cells;
}

std::vector<Index> scatter(const Graph& graph, double radius, std::uint64_t seed) {
    const std::size_t n = graph.size();
    std::vector<std::pair<std::uint64_t, Index>> order(n);
    for (std::size_t v = 0; v < n; ++v)
        order[v] = {random_bits(seed, RandomStream::sampling, 0, v), static_cast<Index>(v)};
    std::sort(order.begin(), order.end());
    std::vector<std::uint8_t> covered(n, 0);
    std::vector<Index> taken;
    Reach reach(graph);
    for (const auto& [key, v] : order) {
        if (covered[at(v)]) continue;
        taken.push_back(v);
        for (const Reach::Hit& hit : reach.within(v, radius)) covered[at(hit.node)] = 1;
    }
    std::sort(taken.begin(), taken.end());
    return taken;
}

void relax(const Graph& graph, std::span<const Vec3> position, std::span<const double> weight, int rounds,
           std::vector<Index>& sources) {
    for (int round = 0; round < rounds; ++round) {
        const Cells cells = nearest_source(graph, sources);
        std::vector<Vec3> centroid(sources.size(), Vec3::Zero());
        std::vector<double> total(sources.size(), 0.0);
        for (std::size_t v = 0; v < graph.size(); ++v) {
            if (cells.label[v] < 0) continue;
            centroid[at(cells.label[v])] += weight[v] * position[v];
            total[at(cells.label[v])] += weight[v];
        }
        std::vector<double> best(sources.size(), far_away);
        std::vector<Index> next = sources;
        for (std::size_t v = 0; v < graph.size(); ++v) {
            if (cells.label[v] < 0) continue;
            const std::size_t s = at(cells.label[v]);
            if (!(total[s] > 0.0)) continue;
            const double d = (position[v] - centroid[s] / total[s]).squaredNorm();
            if (d < best[s]) {
                best[s] = d;
                next[s] = static_cast<Index>(v);
            }
        }
        sources = std::move(next);
    }
    std::sort(sources.begin(), sources.end());
}

std::vector<double> limit_gradient(const Graph& graph, std::span<const double> value, double slope) {
    std::vector<double> limited(value.begin(), value.end());
    Queue queue;
    for (std::size_t v = 0; v < limited.size(); ++v) queue.emplace(limited[v], static_cast<Index>(v));
    settle(graph, limited, queue, slope, [](Index, Index) {});
    return limited;
}

}  // namespace cathlab
