// Where points of a lumen stand along its vessels, and what medium there is.
#pragma once

#include <span>
#include <vector>

#include "core/centreline.h"
#include "core/parallel.h"

namespace cathlab {

/// Between two neighbours of the graph, at this share of the way from the first.
struct AlongVessel {
    Index from = 0, to = 0;
    double share = 0.0;
};

/// For each point: of the nodes of its own region (of all, where the region has none) the nearest, and on that node's
/// edges the place nearest to the point; an edge into another region where three or more meet begins a branch and is
/// left out.  A front that runs along a vessel then lies straight across it, whatever its
/// triangles; and where the line of a narrow vessel begins within a wide one, the wide one's wall stands along its own.
/// points (n) mm; region (n), as the nodes' regions; the graph must have a node.
std::vector<AlongVessel> along_vessels(const CentrelineGraph& graph, std::span<const Vec3> points,
                                       std::span<const Index> region, const Workers& workers);

/// c = (1 - share) c_from + share c_to, in the unit of the nodes' concentration.
inline double concentration_at(const AlongVessel& a, std::span<const double> concentration) {
    return (1.0 - a.share) * concentration[static_cast<std::size_t>(a.from)] +
           a.share * concentration[static_cast<std::size_t>(a.to)];
}

}  // namespace cathlab
