// What a position sensor sees: shared by the effects that stand between a place and its reading.
#pragma once

#include "core/channels.h"
#include "core/types.h"

namespace cathlab {

/// Replaces the read place of each tracked tip, mm, world: place <- f(which, place).  which = 0 wire, 1 catheter.
template <class F>
void for_each_tip(Channels& c, F&& f) {
    const auto apply = [&](int which, double& x, double& y, double& z) {
        const Vec3 read = f(which, Vec3(x, y, z));
        x = read.x();
        y = read.y();
        z = read.z();
    };
    apply(0, c.wire_tip_x_mm, c.wire_tip_y_mm, c.wire_tip_z_mm);
    apply(1, c.catheter_tip_x_mm, c.catheter_tip_y_mm, c.catheter_tip_z_mm);
}

}  // namespace cathlab
