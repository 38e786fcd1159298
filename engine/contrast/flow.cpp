#include "contrast/flow.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <queue>

#include "core/check.h"
#include "core/range.h"
#include "core/units.h"

namespace cathlab {
namespace {

std::size_t at(Index i) {
    return static_cast<std::size_t>(i);
}

double cube(double x) {
    return x * x * x;
}

// Shortest distance from the root, and the neighbour it comes by.
void shortest_ways(const CentrelineGraph& graph, Index root, std::vector<double>& distance,
                   std::vector<Index>& before) {
    const auto neighbours = graph.adjacency();
    distance.assign(graph.nodes.size(), std::numeric_limits<double>::infinity());
    before.assign(graph.nodes.size(), -1);
    using Entry = std::pair<double, Index>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
    distance[at(root)] = 0.0;
    queue.emplace(0.0, root);
    while (!queue.empty()) {
        const auto [d, node] = queue.top();
        queue.pop();
        if (d > distance[at(node)]) continue;
        for (const Index next : neighbours[at(node)]) {
            const double candidate =
                d + std::sqrt((graph.nodes[at(next)].position - graph.nodes[at(node)].position).squaredNorm());
            if (candidate < distance[at(next)]) {
                distance[at(next)] = candidate;
                before[at(next)] = node;
                queue.emplace(candidate, next);
            }
        }
    }
}

// What leaves the tree at each node, summing to the cardiac output.
std::vector<double> end_flows(const CentrelineGraph& graph, Index root, const std::vector<double>& distance,
                              const ContrastSpec& spec) {
    const std::size_t n = graph.nodes.size();
    std::vector<int> degree(n, 0);
    for (const auto& [a, b] : graph.edges) {
        ++degree[at(a)];
        ++degree[at(b)];
    }
    const auto share_of = [&](std::size_t i) {
        const std::size_t region = at(graph.nodes[i].region);
        return region < spec.region_share.size() ? spec.region_share[region] : -1.0;
    };
    std::vector<double> weight(n, 0.0), region_weight(spec.region_share.size(), 0.0);
    double free_weight = 0.0;
    for (std::size_t i = 0; i < n; ++i) {
        if (degree[i] != 1 || static_cast<Index>(i) == root || !std::isfinite(distance[i])) continue;
        weight[i] = cube(graph.nodes[i].radius);
        if (share_of(i) >= 0.0)
            region_weight[at(graph.nodes[i].region)] += weight[i];
        else
            free_weight += weight[i];
    }
    double given = 0.0;
    for (std::size_t r = 0; r < region_weight.size(); ++r)
        if (region_weight[r] > 0.0) given += spec.region_share[r];
    if (free_weight <= 0.0 && given <= 0.0)
        throw UserError("contrast: no end of the vessel tree can be reached from the root");
    const double rest = free_weight > 0.0 ? 1.0 - given : 0.0;
    const double scale = spec.cardiac_output_ml_s / (given + rest);
    for (std::size_t i = 0; i < n; ++i) {
        if (weight[i] <= 0.0) continue;
        const double share = share_of(i);
        weight[i] *=
            share >= 0.0 ? scale * share / region_weight[at(graph.nodes[i].region)] : scale * rest / free_weight;
    }
    return weight;
}

}  // namespace

void validate(const ContrastSpec& spec, const SourcePlace& where) {
    require_range(where, "cardiac_output_ml_s", spec.cardiac_output_ml_s, 1.0, 500.0);
    require_range(where, "concentration_mgi_ml", spec.concentration_mgi_ml, 1.0, 400.0);
    double sum = 0.0;
    for (const double share : spec.region_share) {
        require_range(where, "region_share", share, -1.0, 1.0);
        sum += std::max(0.0, share);
    }
    require_range(where, "region_share (sum)", sum, 0.0, 1.0);
}

ContrastModel build_contrast(const CentrelineGraph& graph, Index root, const ContrastSpec& spec) {
    CATHLAB_CHECK(root >= 0 && at(root) < graph.nodes.size(), "the root is a node of the graph");
    const std::size_t n = graph.nodes.size();
    std::vector<double> distance;
    std::vector<Index> before;
    shortest_ways(graph, root, distance, before);

    ContrastModel model;
    model.spec = spec;
    model.root = root;
    model.volume_ml.assign(n, 0.0);
    model.upstream_edge.assign(n, -1);
    std::vector<double> edge_weight;
    std::vector<std::vector<std::size_t>> incoming(n);
    for (auto [a, b] : graph.edges) {
        const auto key = [&](Index node) { return std::pair(distance[at(node)], node); };
        if (key(b) < key(a)) std::swap(a, b);
        const double length = std::sqrt((graph.nodes[at(a)].position - graph.nodes[at(b)].position).squaredNorm());
        for (const Index node : {a, b})  // each end stands for the half of the edge next to it
            model.volume_ml[at(node)] +=
                0.5 * length * units::pi * graph.nodes[at(node)].radius * graph.nodes[at(node)].radius / 1000.0;
        if (!std::isfinite(distance[at(a)])) continue;
        if (before[at(b)] == a) model.upstream_edge[at(b)] = static_cast<Index>(model.edges.size());
        incoming[at(b)].push_back(model.edges.size());
        model.edges.push_back({a, b, 0.0});
        edge_weight.push_back(cube(std::min(graph.nodes[at(a)].radius, graph.nodes[at(b)].radius)));
    }
    // From the far ends back: a node's need is its own outflow and what its downstream edges carry.
    std::vector<double> need = end_flows(graph, root, distance, spec);
    model.outflow_ml_s = need;
    std::vector<std::size_t> order(n);
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(),
              [&](std::size_t a, std::size_t b) { return std::pair(distance[a], a) > std::pair(distance[b], b); });
    for (const std::size_t node : order) {
        double weight = 0.0;
        for (const std::size_t e : incoming[node]) weight += edge_weight[e];
        if (need[node] <= 0.0 || weight <= 0.0) continue;
        for (const std::size_t e : incoming[node]) {
            model.edges[e].flow_ml_s = need[node] * edge_weight[e] / weight;
            need[at(model.edges[e].from)] += model.edges[e].flow_ml_s;
        }
    }
    return model;
}

}  // namespace cathlab
