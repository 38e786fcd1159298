// The projection of the views that a camera inside or outside the vessels sees.
#pragma once

#include <array>
#include <cmath>

#include "core/units.h"

namespace cathlab {

/// Column-major, for OpenGL: perspective with z forward between two distances in mm; the field of view is the vertical
/// one.  Row 0 of the picture is y = -height, so GL's up is our down.
inline std::array<float, 16> perspective_matrix(double field_of_view_deg, double aspect, double near_mm,
                                                double far_mm) {
    const double f = 1.0 / std::tan(0.5 * field_of_view_deg * units::deg);
    std::array<float, 16> m{};
    m[0] = static_cast<float>(f / aspect);
    m[5] = static_cast<float>(f);
    m[10] = static_cast<float>((far_mm + near_mm) / (far_mm - near_mm));
    m[14] = static_cast<float>(-2 * far_mm * near_mm / (far_mm - near_mm));
    m[11] = 1.0F;
    return m;
}

}  // namespace cathlab
