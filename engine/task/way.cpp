#include "task/way.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/errors.h"

namespace cathlab {

namespace {

constexpr double clearly_mm = 4.0;  // so much nearer to another vessel, lumen radii taken off, is astray

std::size_t at_index(Index i) {
    return static_cast<std::size_t>(i);
}

}  // namespace

Way::Way(const CentrelineGraph& graph, Index from, Index to) : graph_(&graph), nodes_(graph.path(from, to)) {
    if (nodes_.size() < 2) throw UserError("no vessel leads from the entry site to the task's goal");
    on_way_.assign(graph.nodes.size(), false);
    arc_.push_back(0.0);
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
        on_way_[at_index(nodes_[i])] = true;
        if (i == 0) continue;
        const Vec3 step = graph.nodes[at_index(nodes_[i])].position - graph.nodes[at_index(nodes_[i - 1])].position;
        arc_.push_back(arc_.back() + std::sqrt(step.squaredNorm()));
    }
}

Way::Place Way::locate(const Vec3& tip) const {
    Place out;
    double best = std::numeric_limits<double>::infinity(), elsewhere = best;
    const auto to_wall = [&](Index i) {
        const CentrelineNode& node = graph_->nodes[at_index(i)];
        return std::sqrt((tip - node.position).squaredNorm()) - node.radius;
    };
    for (std::size_t k = 0; k < nodes_.size(); ++k) {
        const double d = to_wall(nodes_[k]);
        if (d >= best) continue;
        best = d;
        out.arc_mm = arc_[k];
        out.radius_mm = graph_->nodes[at_index(nodes_[k])].radius;
        out.off_mm = d + out.radius_mm;
    }
    for (std::size_t i = 0; i < graph_->nodes.size(); ++i)
        if (!on_way_[i]) elsewhere = std::min(elsewhere, to_wall(static_cast<Index>(i)));
    // Outside the way's own lumen and clearly inside another's.
    out.astray = best > 0.0 && elsewhere + clearly_mm < best;
    return out;
}

Vec3 Way::at(double arc_mm) const {
    const auto next = std::lower_bound(arc_.begin(), arc_.end(), arc_mm);
    if (next == arc_.begin()) return graph_->nodes[at_index(nodes_.front())].position;
    if (next == arc_.end()) return graph_->nodes[at_index(nodes_.back())].position;
    const auto k = static_cast<std::size_t>(next - arc_.begin());
    const double share = (arc_mm - arc_[k - 1]) / (arc_[k] - arc_[k - 1]);
    return (1.0 - share) * graph_->nodes[at_index(nodes_[k - 1])].position +
           share * graph_->nodes[at_index(nodes_[k])].position;
}

std::vector<CentrelineNode> Way::between(double from_mm, double to_mm) const {
    std::vector<CentrelineNode> out;
    for (std::size_t k = 0; k < nodes_.size(); ++k)
        if (arc_[k] >= from_mm && arc_[k] <= to_mm) out.push_back(graph_->nodes[at_index(nodes_[k])]);
    return out;
}

}  // namespace cathlab
