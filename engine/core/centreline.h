// The centre-line graph of a vascular tree: nodes with a lumen radius, edges with a region.  Loops are allowed.
#pragma once

#include <string>
#include <vector>

#include "core/types.h"

namespace cathlab {

struct CentrelineNode {
    Vec3 position = Vec3::Zero();  ///< mm, world
    double radius = 0.0;           ///< radius of the lumen there, mm
    Index region = 0;              ///< index into the anatomy's regions
};

struct CentrelineGraph {
    std::vector<CentrelineNode> nodes;
    std::vector<std::pair<Index, Index>> edges;  ///< undirected; neighbours stand 1 to 4 mm apart

    /// Neighbours of every node, ascending.
    std::vector<std::vector<Index>> adjacency() const;
    /// The node nearest to a point, by distance alone.
    Index nearest(const Vec3& p) const;
    /// Shortest path by arc length, both ends included; empty where there is none.
    std::vector<Index> path(Index from, Index to) const;
    /// Arc length of a node path, mm.
    double length(const std::vector<Index>& path) const;
};

}  // namespace cathlab
