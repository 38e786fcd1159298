// The last resort: what devices are still too deep in the wall after a substep's passes is taken out by moving the
// wall.
#pragma once

#include <span>
#include <vector>

#include "contact/contact_set.h"

namespace cathlab {

/// A sample that may be too deep, and what is known of the wall about it; as it stands: nothing is, and the nearest
/// wall is believed.
struct PressedSample {
    Index sample = -1;
    Index hint = -1;
    WallSeen seen = {};
};

/// Those that have a row.
std::vector<PressedSample> with_rows(const ContactSet& contacts);

/// Moves particles (mm) so that none of the samples lies deeper in the surface than `depth_mm`, in a few rounds: the
/// surface follows, each sample's closest wall point goes out by the shortest way, w_j / sum w^2 of it to each of its
/// particles, one sample after the other.  In a fold, whose facets turn as they are pressed, rows that hold a place and
/// a direction can miss that.  A particle goes at most 4 mm in all; where nearly all of a point's particles are fixed
/// it stays; of all rounds the best one stays.  It is a correction of positions after velocities are taken, as the
/// stabilisation of [macklin2014]: it makes no force and no motion. particle_compliance: 0 = stays.  near: where the
/// surface is to follow.  Returns the deepest place that is left, mm.
double push_out(const LumenSurfaceModel& model, const TreePart& near, std::span<const PressedSample> pressed,
                std::span<const DeviceSample> samples, double depth_mm, std::span<const double> particle_compliance,
                std::span<Vec3> particles, LumenSurfaceState& surface, const Workers& workers);

}  // namespace cathlab
