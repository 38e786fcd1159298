// The way from an entry site to a goal along the centre-lines, and where on it a tip is.
#pragma once

#include <vector>

#include "core/centreline.h"

namespace cathlab {

class Way {
public:
    /// From node to node by the shortest path; throws UserError where there is none.
    Way(const CentrelineGraph& graph, Index from, Index to);

    struct Place {
        double arc_mm = 0.0;     ///< from the entry, of the nearest point of the way
        double off_mm = 0.0;     ///< distance from it
        double radius_mm = 0.0;  ///< of the lumen there
        bool astray = false;     ///< the tip is in another vessel
    };
    Place locate(const Vec3& tip) const;

    double length_mm() const { return arc_.back(); }
    /// Beyond either end: the end.
    Vec3 at(double arc_mm) const;
    /// Its nodes from arc to arc.
    std::vector<CentrelineNode> between(double from_mm, double to_mm) const;

private:
    const CentrelineGraph* graph_;
    std::vector<Index> nodes_;
    std::vector<double> arc_;
    std::vector<bool> on_way_;  // one a node of the graph
};

}  // namespace cathlab
