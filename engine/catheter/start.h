// How a catheter lies that stands deep in a curved vessel when a run begins.
#pragma once

#include "catheter/shape.h"

namespace cathlab {

/// Bends the segments so that the steerable part lies along the rail as nearly as its arcs and ranges allow: least
/// squares of the distances to the rail at the same arc length, by Gauss and Newton's method over the two components of
/// each bend.  A vessel holds the tip of a real catheter so.  Where the rail is straight, so are the segments.
void lie_along(const CatheterSpec& spec, CatheterState& state, const Rail& rail);

}  // namespace cathlab
