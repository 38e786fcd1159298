#include "scene/flow_root.h"

#include <algorithm>
#include <cstddef>
#include <limits>

namespace cathlab {
namespace {

using Neighbours = std::vector<std::vector<Index>>;

std::size_t at(Index i) {
    return static_cast<std::size_t>(i);
}

bool is_end(const Neighbours& neighbours, Index node) {
    return neighbours[at(node)].size() == 1;
}

// From `previous` by way of `here` to the first node that is no mere link of two: a free end or a branch.
std::vector<Index> run(const Neighbours& neighbours, Index previous, Index here) {
    std::vector<Index> out{previous};
    while (here != out.back() && out.size() <= neighbours.size()) {
        previous = out.back();
        out.push_back(here);
        const std::vector<Index>& next = neighbours[at(here)];
        if (next.size() == 2) here = next[0] == previous ? next[1] : next[0];
    }
    return out;
}

// The free end with the least cost; 0 in a graph without ends.
template <class Cost>
Index best_end(const CentrelineGraph& graph, const Neighbours& neighbours, Cost cost) {
    Index best = 0;
    double least = std::numeric_limits<double>::infinity();
    for (Index i = 0; at(i) < graph.nodes.size(); ++i) {
        if (!is_end(neighbours, i)) continue;
        const double c = cost(i);
        if (c >= least) continue;
        least = c;
        best = i;
    }
    return best;
}

// Median radius of the vessel that ends there, up to its first branch: at the end itself the centre-line of a mesh runs
// into the cap, and its radius says little.
double width(const CentrelineGraph& graph, const Neighbours& neighbours, Index end) {
    std::vector<double> radius;
    for (const Index node : run(neighbours, end, neighbours[at(end)].front()))
        radius.push_back(graph.nodes[at(node)].radius);
    const auto middle = radius.begin() + static_cast<std::ptrdiff_t>(radius.size() / 2);
    std::nth_element(radius.begin(), middle, radius.end());
    return *middle;
}

// From the sheath's mouth outwards to where the vessel ends.
Index end_behind(const EntrySite& entry, const CentrelineGraph& graph, const Neighbours& neighbours) {
    if (neighbours[at(entry.node)].size() < 2) return entry.node;
    const Vec3 inward = entry.pose.orientation * Vec3::UnitZ();
    Index outward = entry.node;
    double least = std::numeric_limits<double>::infinity();
    for (const Index next : neighbours[at(entry.node)]) {
        const Vec3 way = graph.nodes[at(next)].position - graph.nodes[at(entry.node)].position;
        if (way.normalized().dot(inward) >= least) continue;
        least = way.normalized().dot(inward);
        outward = next;
    }
    return run(neighbours, entry.node, outward).back();
}

}  // namespace

Index flow_root(const AnatomyModel& anatomy, const SceneContrast& wanted) {
    const CentrelineGraph& graph = anatomy.centreline;
    const Neighbours neighbours = graph.adjacency();
    const std::string& name = wanted.root.name;
    if (name.empty())
        return best_end(graph, neighbours,
                        [&](Index i) { return (graph.nodes[at(i)].position - wanted.root.point).squaredNorm(); });
    if (anatomy.annulus && (name == "auto" || name == "annulus")) return graph.nearest(anatomy.annulus->pose.position);
    if (name == "auto") return best_end(graph, neighbours, [&](Index i) { return -width(graph, neighbours, i); });

    std::vector<std::string> names{"auto"};
    if (anatomy.annulus) names.emplace_back("annulus");
    for (const Landmark& landmark : anatomy.landmarks) {
        if (!is_end(neighbours, landmark.node)) continue;
        if (landmark.name == name) return landmark.node;
        names.push_back(landmark.name);
    }
    for (const EntrySite& entry : anatomy.entries) {
        const Index end = end_behind(entry, graph, neighbours);
        if (!is_end(neighbours, end)) continue;
        if (entry.name == name) return end;
        names.push_back(entry.name);
    }
    throw UserError(wanted.where, "root: the anatomy has no end '" + name + "'; it has " + comma_list(names) +
                                      did_you_mean(name, names));
}

}  // namespace cathlab
