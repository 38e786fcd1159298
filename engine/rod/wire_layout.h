// Where the links of a wire lie that is placed along a path: chords of exactly a link's length, frames without twist.
#pragma once

#include <span>

#include "core/types.h"
#include "rod/wire_links.h"

namespace cathlab {

/// Poses of the first `free` links when `insertion` mm of wire stand beyond `mouth` (z inward) along `path`.  The path
/// is joined to the mouth by a straight line and goes straight on at its end.  Each joint is the next point of the path
/// at the link's length from the joint behind it, so nothing is stretched; the frames are carried along from the mouth
/// by the smallest rotation from link to link.
std::vector<Pose> lay_along(std::span<const WireLink> links, std::size_t free, double insertion, const Pose& mouth,
                            std::span<const Vec3> path);

}  // namespace cathlab
