// Contact rows between the heart's cylinder and wall particles: one-sided, the cylinder never pulls.
#pragma once

#include <span>
#include <vector>

#include "heart/motion.h"

namespace cathlab {

/// The particle stays on the outer side of a plane that moves with the cylinder: gap(x) = normal . (x - anchor) >= 0.
/// The caller solves it with the particle's compliance c (mm/mN): multiplier' = max(0, multiplier - gap / c).
struct CylinderRow {
    Index particle = 0;
    Vec3 normal = Vec3::UnitZ();  ///< unit, world, out of the cylinder
    Vec3 anchor = Vec3::Zero();   ///< a point of the cylinder's surface, world
    double gap = 0.0;             ///< mm at the position given, negative = inside

    double gap_at(const Vec3& x) const { return normal.dot(x - anchor); }
};

/// Rows of the particles inside the cylinder or within margin_mm of it, in the order of `candidates` (all if empty).
/// A particle over the face, or below it by less than face_depth_mm, is pushed along the axis; one that is deeper, or
/// beside, is pushed out to the side (the nearer surface would let a ring at the rim slip off the face).
void find_rows(const HeartSpec& spec, const Pose& cylinder, std::span<const Vec3> particles,
               std::span<const Index> candidates, double margin_mm, std::vector<CylinderRow>& rows);

inline constexpr double face_depth_mm = 6.0;

}  // namespace cathlab
