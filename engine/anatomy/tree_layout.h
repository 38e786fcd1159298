// Curves of all vessels of a spec, where they branch, and what of that is needed again after the surface is made.
#pragma once

#include <memory>

#include "anatomy/implicit_tree.h"
#include "anatomy/model.h"

namespace cathlab {

struct TreeLayout {
    std::unique_ptr<ImplicitTree> tree;
    std::vector<Index> parent;         ///< one a vessel, -1 for the root
    std::vector<double> attach_arc;    ///< on the parent's centre-line
    std::vector<Index> region;         ///< one a vessel
    std::vector<double> least_radius;  ///< one a vessel
};

/// Throws UserError where the vessels cannot be laid out (see build_anatomy).
TreeLayout lay_out(const AnatomySpec& spec);

/// The centre-line graph, and for each node its vessel and arc length on it.
struct GraphPlaces {
    CentrelineGraph graph;
    std::vector<Index> vessel;
    std::vector<double> arc;
    Index nearest(Index on_vessel, double at_arc) const;
};
GraphPlaces make_graph(const TreeLayout& layout);

/// Fills regions, entries, fixed zones, landmarks and the annulus.
void place_names(const AnatomySpec& spec, const TreeLayout& layout, const GraphPlaces& graph, AnatomyModel& model);

}  // namespace cathlab
