#include "play/stick.h"

#include <algorithm>
#include <cmath>

namespace cathlab::play {

double shaped(const StickShape& shape, double raw) {
    const double span = std::max(1e-6, 1.0 - shape.outer_zone - shape.dead_zone);
    const double s = std::clamp((std::fabs(raw) - shape.dead_zone) / span, 0.0, 1.0);
    return std::copysign(std::pow(s, shape.curve), raw);
}

StickPlace shaped(const StickShape& shape, StickPlace raw) {
    const double r = std::hypot(raw.x, raw.y);
    const double length = shaped(shape, r);
    if (length <= 0.0) return {};
    // Along the direction of the stick; a corner of a square gate does not go beyond 1 in either axis.
    return {std::clamp(length * raw.x / r, -1.0, 1.0), std::clamp(length * raw.y / r, -1.0, 1.0)};
}

}  // namespace cathlab::play
