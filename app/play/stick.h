// From a stick's raw place to a speed's share: a radial dead zone, rescaled from 0, and a curve.
#pragma once

namespace cathlab::play {

struct StickShape {
    double dead_zone = 0.15;   ///< radius below which the stick is at rest, [0, 0.9]
    double outer_zone = 0.05;  ///< from the rim inward it counts as full, [0, 0.5]
    double curve = 1.6;        ///< exponent of what is left, [1, 4]: 1 = straight, more = finer near the middle
};

struct StickPlace {
    double x = 0.0, y = 0.0;
};

/// r = |(x, y)|, s = clamp((r - dead) / (1 - outer - dead), 0, 1); the result points where the stick points, with the
/// length s^curve.
StickPlace shaped(const StickShape& shape, StickPlace raw);

/// The same of one number in [0, 1]: a trigger, or a stick's axis alone.
double shaped(const StickShape& shape, double raw);

}  // namespace cathlab::play
