// Contact rows: one point of a device against one place of the wall.
#pragma once

#include "core/types.h"
#include "rod/chain_row.h"

namespace cathlab {

/// A sphere on a device's axis that may touch the wall.
struct DeviceSample {
    Vec3 position = Vec3::Zero();  ///< centre, mm, world, now
    double radius = 0.0;           ///< mm, > 0
    Index device = 0;              ///< which device; rows are sorted by it
    double arc_mm = 0.0;  ///< material arc length from the device's tip: names the sample while the device is fed in
    Index link = 0;       ///< link of the chain (0 = tip)
    Vec3 arm = Vec3::Zero();  ///< from the link's centre to the sample's centre, mm, world
    double friction = 0.1;    ///< Coulomb coefficient against the wall, >= 0
    Index hint = -1;          ///< triangle to start from; -1 = what the set remembers of this sample
    int walls = 0;  ///< rows at most, 0 = as the set's settings say; the front end of a device meets several walls
    bool kinematic = false;  ///< the device does not give way (steerable catheter): solve_kinematic takes its rows
    double yields =
        0.0;  ///< a kinematic device's: the share of its tip's yielding that this point takes part in, 0 to 1
    Vec3 previous = Vec3::Zero();  ///< position at the beginning of the substep, mm, world
    Vec3 rotation = Vec3::Zero();  ///< rotation vector of the link since the beginning of the substep, rad, world: a
                                   ///< turning wire rubs on the wall
};

/// The wall's side of a row; the device's side is the ChainRow of the same index.
struct WallRow {
    Index sample = 0;  ///< index into the samples given to detect
    Index device = 0;
    Index triangle = 0;
    Index region = 0;
    bool kinematic = false;
    double radius = 0.0;               ///< of the sample, mm
    double arc_mm = 0.0;               ///< of the sample
    double offset = 0.0;               ///< gap = n . (p - q) - offset, mm
    Vec3 barycentric = Vec3::Zero();   ///< of the wall point in its triangle
    Vec3 point = Vec3::Zero();         ///< wall point q = sum w_j x_j at the last refresh, mm, world
    Vec3 found = Vec3::Zero();         ///< p - q when the row was made
    Vec3 separation = Vec3::Zero();    ///< p - q at the last refresh
    Vec3 point_before = Vec3::Zero();  ///< q at the beginning of the substep
    std::size_t begin = 0,
                end = 0;  ///< its particles and weights in ContactSet::particles(), ::weights(): w_j = sum_k b_k w_kj
};

/// The part of v across a unit normal.
inline Vec3 tangential(const Vec3& v, const Vec3& normal) {
    return v - v.dot(normal) * normal;
}

/// t, or what points the same way and is as long as the limit.
inline Vec3 into_cone(const Vec3& t, double limit) {
    const double size = t.norm();
    return size > limit ? Vec3(t * (limit / size)) : t;
}

}  // namespace cathlab
