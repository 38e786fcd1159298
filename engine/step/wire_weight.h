// What gravity does to the guidewire: one force a link, for Rod::predict.
#pragma once

#include <vector>

#include "core/types.h"
#include "rod/rod.h"

namespace cathlab {

/// m g on the centre of each link that is beyond the sheath, mN, tip first; empty where there is no gravity, so that
/// such a world is bit-identical to one without this.  gravity: mm/s2, world.
std::vector<Vec3> wire_weight(const Rod& wire, const Vec3& gravity);

}  // namespace cathlab
