#include "step/force_bar.h"

#include <cmath>

#include "core/check.h"
#include "core/units.h"

namespace cathlab {

ForceBar ForceBar::with_filter(double filter_s, double dt) {
    CATHLAB_CHECK(dt > 0.0 && filter_s >= 0.0, "a filter needs a step");
    const double count = std::floor(filter_s / dt + 0.5);
    ForceBar bar;
    bar.window_mn.assign(static_cast<std::size_t>(count < 1.0 ? 1.0 : count), 0.0);
    return bar;
}

double ForceBar::add(double shaft_force_mn) {
    window_mn[static_cast<std::size_t>(next)] = shaft_force_mn;
    next = (next + 1) % static_cast<std::int64_t>(window_mn.size());
    double sum = 0.0;
    for (const double f : window_mn) sum += f;
    return sum / static_cast<double>(window_mn.size()) / units::newton;
}

}  // namespace cathlab
