#include "heart/cylinder_rows.h"

#include <cmath>

namespace cathlab {

void find_rows(const HeartSpec& spec, const Pose& cylinder, std::span<const Vec3> particles,
               std::span<const Index> candidates, double margin_mm, std::vector<CylinderRow>& rows) {
    rows.clear();
    const Mat3 axes = cylinder.orientation.toRotationMatrix();
    const Vec3 axis = axes.col(2);
    const std::size_t count = candidates.empty() ? particles.size() : candidates.size();
    for (std::size_t k = 0; k < count; ++k) {
        const Index particle = candidates.empty() ? static_cast<Index>(k) : candidates[k];
        const Vec3& x = particles[static_cast<std::size_t>(particle)];
        const Vec3 from_face = x - cylinder.position;
        const double z = axis.dot(from_face);
        if (z > margin_mm || z < -spec.height_mm) continue;
        const Vec3 outward = from_face - z * axis;
        const double from_axis = std::sqrt(outward.squaredNorm());
        if (from_axis > spec.radius_mm + margin_mm) continue;
        CylinderRow row;
        row.particle = particle;
        if (from_axis <= spec.radius_mm && (z > -face_depth_mm || from_axis < 1e-9)) {
            row.normal = axis;
            row.anchor = cylinder.position;
        } else {
            if (z > 0.0) continue;  // beside and above the face: free
            row.normal = outward / from_axis;
            row.anchor = cylinder.position + z * axis + spec.radius_mm * row.normal;
        }
        row.gap = row.gap_at(x);
        rows.push_back(row);
    }
}

}  // namespace cathlab
