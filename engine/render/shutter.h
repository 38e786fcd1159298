// The collimator's blades in the picture.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "render/frame_description.h"

namespace cathlab {

/// Whether a coordinate v of n pixels lies within the open share, which is centred.
inline bool is_open(double v, int n, double share) {
    return std::fabs(v / n - 0.5) <= 0.5 * share;
}

/// What the blades shade is shown black, as machines do: scatter alone would leave a dark grey there.
void blacken_shaded(const CArmView& view, std::size_t columns, std::vector<std::uint8_t>& grey);

}  // namespace cathlab
