// Where the blood goes: mean flow along every edge of the centre-line graph, from the aortic root to the ends.
#pragma once

#include <string>
#include <vector>

#include "core/centreline.h"
#include "core/errors.h"

namespace cathlab {

struct ContrastSpec {
    double cardiac_output_ml_s = 83.0;    ///< 5 L/min, an adult at rest [guyton2006]; 1 to 500
    double concentration_mgi_ml = 350.0;  ///< of the medium, 1 to 400
    std::vector<double> region_share;  ///< one a region or empty: part of the output that leaves through the region's
                                       ///< ends; negative = shares what is left with the others by radius^3
    std::string source = "guyton2006, murray1926";
};

/// Throws UserError: numbers out of range, shares that sum to more than 1.
void validate(const ContrastSpec& spec, const SourcePlace& where = {});

/// Const after load.
struct ContrastModel {
    struct Edge {
        Index from = 0, to = 0;  ///< in the direction of the mean flow: away from the root
        double flow_ml_s = 0.0;  ///< >= 0
    };
    ContrastSpec spec;
    Index root = 0;  ///< where the heart's output enters
    std::vector<Edge> edges;
    std::vector<double> volume_ml;     ///< of the lumen that each node stands for
    std::vector<double> outflow_ml_s;  ///< that leaves the tree at a node; > 0 at ends only
    std::vector<Index>
        upstream_edge;  ///< the edge on the shortest way from the root; -1 at the root and where none leads
};

/// Orients the graph by shortest distance from the root and shares the output among the ends: an end takes its region's
/// share, or a part by the cube of its radius [murray1926]; a node's need is met by its upstream edges in proportion to
/// their radius cubed, so flow is conserved at every node exactly.  A branch that leads to no end carries none.  Throws
/// UserError where nothing leads away from the root.
ContrastModel build_contrast(const CentrelineGraph& graph, Index root, const ContrastSpec& spec);

}  // namespace cathlab
