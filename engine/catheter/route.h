// The route: which vessels the shaft runs through, as nodes of the centre-line graph from the entry site on.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "catheter/rail.h"
#include "core/centreline.h"

namespace cathlab {

/// The centre-line graph as seen from one entry site.  Const after load.
struct RouteGraph {
    std::vector<std::vector<Index>> neighbours;
    std::vector<double> radius;  ///< of the lumen at each node, mm
    Index entry = 0;
    Index first = -1;  ///< the neighbour of the entry that lies most along the sheath
};

/// Throws UserError where the entry has no neighbour.  mouth.z points into the vessel.
RouteGraph build_route_graph(const CentrelineGraph& graph, Index entry, const Pose& mouth);

/// The route reaches this far beyond the base at least, so that a change at its end can never move the base.
inline constexpr double route_lookahead_mm = 30.0;

/// Brings the route to the first node that lies `lookahead_mm` or more beyond the base, measured along the nodes'
/// current `positions`.  What lies farther is forgotten: a branch passed on the way back is chosen anew next time.
/// Where the vessel divides, that branch is taken whose centre-line, a lumen radius and 10 mm from the fork, is nearest
/// to `guide` (a polyline: the steerable part prolonged beyond its tip, or a wire); so steering picks the branch, and a
/// tip bent inside a wide vessel does not.  A node already on the route is never taken again; a branch that turns back
/// by more than 120 degrees, or that leads nowhere but into the route again (the other side of a loop), only where
/// there is no other.
void update_route(const RouteGraph& graph, std::span<const Vec3> positions, std::span<const Vec3> guide,
                  double base_arc_mm, std::vector<std::int64_t>& route, double lookahead_mm = route_lookahead_mm);

/// Farthest insertion at which a straight catheter still ends inside the graph: length of the route and of the longest
/// way on from its end (looked for up to `look_mm` beyond the end), mm.
double insertion_limit(const RouteGraph& graph, std::span<const Vec3> positions, const std::vector<std::int64_t>& route,
                       double look_mm);

/// Gathers the route's current positions and radii and builds the rail.
Rail build_rail(const RouteGraph& graph, std::span<const Vec3> positions, const std::vector<std::int64_t>& route,
                const Pose& mouth, const RailShape& shape = {});

}  // namespace cathlab
