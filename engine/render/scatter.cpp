#include "render/scatter.h"

#include <algorithm>

namespace cathlab {

double scatter_to_primary(double water_mm, double side_mm) {
    constexpr double per_mm = 0.025, half_side_mm = 110.0, behind_grid_and_gap = 0.1;
    return behind_grid_and_gap * per_mm * std::max(0.0, water_mm) * side_mm / (side_mm + half_side_mm);
}

}  // namespace cathlab
