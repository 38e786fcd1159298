// Which way the vessel runs at places on its wall: collagen lies about the circumference, across that way.
#pragma once

#include <span>
#include <vector>

#include "core/centreline.h"

namespace cathlab {

/// Unit vectors along the centre-line (of either sign), one a place; zero where the graph has no edge.  The node asked
/// is the nearest in units of its own radius, so that a thin branch has no say on a wide vessel's wall; where vessels
/// meet, the two edges that go on most nearly straight.
std::vector<Vec3> vessel_directions(const CentrelineGraph& graph, std::span<const Vec3> places);

}  // namespace cathlab
