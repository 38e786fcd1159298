// The last resort: what devices are still too deep in the wall after a substep's passes is taken out by moving the
// wall.
#pragma once

#include <span>

#include "contact/contact_set.h"

namespace cathlab {

/// Moves particles (mm) so that no sample that has a row lies deeper in the surface than `depth_mm`, in a few rounds:
/// the surface follows, each sample's closest wall point goes out by the shortest way, w_j / sum w^2 of it to each of
/// its particles.  In a fold, whose facets turn as they are pressed, rows that hold a place and a direction can miss
/// that.  A particle goes at most 4 mm in all; where nearly all of a point's particles are fixed it stays; of all
/// rounds the best one stays.  It is a correction of positions after velocities are taken, as the stabilisation of
/// [macklin2014]: it makes no force and no motion. particle_compliance: 0 = stays.  near: where the surface is to
/// follow.  Returns the deepest place that is left, mm.
double push_out(const LumenSurfaceModel& model, const TreePart& near, const ContactSet& contacts,
                std::span<const DeviceSample> samples, double depth_mm, std::span<const double> particle_compliance,
                std::span<Vec3> particles, LumenSurfaceState& surface, const Workers& workers);

}  // namespace cathlab
