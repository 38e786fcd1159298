#include "scene/vessel_direction.h"

#include <algorithm>
#include <limits>

namespace cathlab {
namespace {

Vec3 direction_at(const CentrelineGraph& graph, Index node, const std::vector<Index>& neighbours) {
    const auto towards = [&](Index other) {
        return Vec3((graph.nodes[static_cast<std::size_t>(other)].position -
                     graph.nodes[static_cast<std::size_t>(node)].position)
                        .stableNormalized());
    };
    if (neighbours.empty()) return Vec3::Zero();
    if (neighbours.size() == 1) return towards(neighbours.front());
    Vec3 best = Vec3::Zero();
    for (std::size_t a = 0; a < neighbours.size(); ++a)
        for (std::size_t b = a + 1; b < neighbours.size(); ++b) {
            const Vec3 through = towards(neighbours[b]) - towards(neighbours[a]);
            if (through.squaredNorm() > best.squaredNorm()) best = through;
        }
    return best.stableNormalized();
}

}  // namespace

std::vector<Vec3> vessel_directions(const CentrelineGraph& graph, std::span<const Vec3> places) {
    const auto neighbours = graph.adjacency();
    std::vector<Vec3> at_node;
    for (std::size_t i = 0; i < graph.nodes.size(); ++i)
        at_node.push_back(direction_at(graph, static_cast<Index>(i), neighbours[i]));
    std::vector<Vec3> out;
    for (const Vec3& p : places) {
        double nearest = std::numeric_limits<double>::infinity();
        Vec3 direction = Vec3::Zero();
        for (std::size_t i = 0; i < graph.nodes.size(); ++i) {
            const double radius = std::max(graph.nodes[i].radius, 1e-3);
            const double distance = (graph.nodes[i].position - p).squaredNorm() / (radius * radius);
            if (distance >= nearest) continue;
            nearest = distance;
            direction = at_node[i];
        }
        out.push_back(direction);
    }
    return out;
}

}  // namespace cathlab
