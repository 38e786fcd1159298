// Bones, lungs, heart and body outline of an adult round the default tree, for the X-ray image.
#pragma once

#include "anatomy/model.h"
#include "core/parallel.h"

namespace cathlab {

/// Closed solids in the frame of the default adult (origin at the annulus).  They nest: a solid lies wholly inside the
/// one that it names, and solids with the same parent do not meet.  A few thousand triangles in all.
std::vector<ContextSolid> make_torso(const Workers& workers);

}  // namespace cathlab
