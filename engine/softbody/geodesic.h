// Distances along a graph (a mesh's edges, a wall's links): what blue noise, cells and clusters are grown with.
// Nothing here jumps through the air, so that two vessels that lie side by side never share anything.
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "core/types.h"

namespace cathlab {

/// Undirected graph in compressed rows: the neighbours of v are neighbour[start[v] .. start[v+1]), with edge lengths >
/// 0.
struct Graph {
    std::vector<Index> start;      ///< (n + 1)
    std::vector<Index> neighbour;  ///< (2 m), ascending within a row
    std::vector<double> length;    ///< (2 m) mm, or mm over a local spacing where the metric is scaled

    std::size_t size() const { return start.empty() ? 0 : start.size() - 1; }
};

/// The graph of `edges` over n nodes at `position`; edge length = distance of its ends.  Double edges are merged.
Graph make_graph(std::span<const std::pair<Index, Index>> edges, std::span<const Vec3> position);

/// The same edges, each length divided by the mean of `unit` at its two ends: the distance counted in local units.
Graph in_units(const Graph& graph, std::span<const double> unit);

/// One Dijkstra search at a time over a graph, with its arrays kept between searches.
class Reach {
public:
    explicit Reach(const Graph& graph);
    struct Hit {
        Index node;
        double distance;
    };
    /// Nodes within `radius` of `source` in order of distance (ties by index), at most `most` of them.
    const std::vector<Hit>& within(Index source, double radius, std::size_t most = SIZE_MAX);

private:
    const Graph& graph_;
    std::vector<double> distance_;
    std::vector<std::pair<double, Index>> heap_;
    std::vector<Index> touched_;
    std::vector<Hit> hits_;
};

/// Nearest source of every node: label (index into sources, -1 = out of reach) and distance.
struct Cells {
    std::vector<Index> label;
    std::vector<double> distance;
};
Cells nearest_source(const Graph& graph, std::span<const Index> sources);

/// Blue noise: nodes in a random order, each taken unless a taken one lies within `radius`; every node ends up within
/// radius of a taken one.  Ascending.  Maximal packing of this kind leaves 1.44 radius^2 of a flat surface to each.
std::vector<Index> scatter(const Graph& graph, double radius, std::uint64_t seed);

/// Lloyd's relaxation: each source moves to the node of its cell nearest to the cell's centroid, `rounds` times.
/// weight: one a node, the measure of the centroid.
void relax(const Graph& graph, std::span<const Vec3> position, std::span<const double> weight, int rounds,
           std::vector<Index>& sources);

/// value_i <- min over j of (value_j + slope * distance(i, j)): the largest field below `value` with that gradient.
std::vector<double> limit_gradient(const Graph& graph, std::span<const double> value, double slope);

}  // namespace cathlab
