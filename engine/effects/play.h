// Memory of a mechanism: what effects between drive and device share.
#pragma once

#include <cmath>
#include <vector>

#include "effects/effect.h"

namespace cathlab {

/// The play operator: what is dragged along by `in` through a gap that leaves `radius` to either side.
///     out <- out                                  while |in - out| <= radius
///     out <- in - radius (in - out) / |in - out|   otherwise
inline double play(double in, double out, double radius) {
    return in > out + radius ? in - radius : (in < out - radius ? in + radius : out);
}
inline Vec2 play(const Vec2& in, const Vec2& out, double radius) {
    const Vec2 d = in - out;
    const double n = std::sqrt(d.squaredNorm());
    return n <= radius ? out : Vec2(in - (radius / n) * d);
}

/// What a first-order memory holds after `relaxation` (time over time constant, travel over travel constant) during
/// which its input went straight from `before` to `now`:  exact for a ramp.  kept = exp(-relaxation).
template <class T>
T relaxed(const T& memory, const T& before, const T& now, double relaxation, double kept) {
    if (relaxation < 1e-9) return memory;
    const T lag = (now - before) / relaxation;
    return now - lag + kept * (memory - before + lag);
}

/// The value meant for segment i of n: the first is the proximal one, the last the distal one.
inline double of_segment(std::size_t i, std::size_t n, double proximal, double middle, double distal) {
    return i == 0 ? proximal : (i + 1 == n ? distal : middle);
}

/// Bend vectors as an archive takes them.
inline void visit_bends(Archive& archive, std::string_view name, std::vector<Vec2>& bends) {
    for (Vec2& bend : bends) {
        archive.field(name, bend.x());
        archive.field(name, bend.y());
    }
}

}  // namespace cathlab
