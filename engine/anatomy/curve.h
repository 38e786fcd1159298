// A vessel's centre-line as a dense polyline with radii.
#pragma once

#include <span>
#include <vector>

#include "anatomy/spec.h"

namespace cathlab {

/// A point of a vessel's centre-line with the radius of the lumen there, mm.
struct ControlPoint {
    Vec3 position = Vec3::Zero();
    double radius = 0.0;
};

/// Samples of a curve in order; arc[i] is the length along the samples, arc[0] = 0.
struct Curve {
    std::vector<Vec3> position;
    std::vector<double> radius;
    std::vector<double> arc;

    double length() const { return arc.back(); }
    /// Interpolated at arc length s, clamped to the ends.
    Vec3 point(double s) const;
    double radius_at(double s) const;
    Vec3 tangent(double s) const;  ///< unit, along growing s
    double nearest_arc(const Vec3& p) const;
};

/// Centripetal Catmull-Rom through the points (Barry and Goldman's pyramid; alpha = 1/2), sampled at most `step` apart.
/// `before` (may be null): a point before the first one that sets the tangent there.
Curve sample_curve(std::span<const ControlPoint> points, double step, const Vec3* before);

/// Narrows the curve by the stenosis (formula at StenosisSpec); samples it finely enough before.
void narrow(Curve& curve, const StenosisSpec& stenosis);

}  // namespace cathlab
