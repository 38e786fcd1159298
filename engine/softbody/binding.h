// Points that ride on the wall: affine weights over particles, by which forces return.
#pragma once

#include <span>
#include <vector>

#include "core/parallel.h"
#include "core/types.h"
#include "softbody/model.h"

namespace cathlab {

/// q_i = sum over j in [start_i, start_{i+1}) of weight_j x_{particle_j}.  The weights of a point add up to one and
/// reproduce the point at rest, so any affine motion of the particles carries the point along exactly, and a force f on
/// the point, given to the particles as weight_j f, has the same sum and the same torque.
struct PointBinding {
    std::vector<Index> start;  ///< (n + 1)
    std::vector<Index> particle;
    std::vector<double> weight;

    std::size_t size() const { return start.empty() ? 0 : start.size() - 1; }
    double largest_weight() const;  ///< max |w|: forces are spread with it, so it should stay near 1
};

/// Binds points: of the weights that add up to one and reproduce the point, those with the least  sum w_j^2 / phi_j
/// where phi falls smoothly to nothing at the reach of the nearest particles, so that the surface shows no steps.
///   particles_per_point   about so many, >= 4; more are taken where they would need weights above 1 to reproduce the
///   point along_wall            true: the particles are gathered along the wall's links from the nearest one, so a
///   vertex of one
///                         vessel never uses another's; false: nearest in space (nodes of a centre-line)
///   normals               one a point (unit, out of the lumen) or empty: of two walls that lie back to back, the
///   nearest
///                         particle is looked for on the one that faces the same way
/// Throws UserError where a point cannot be reproduced from the particles near it (all in one plane and the point
/// beside it).
PointBinding bind_points(const SoftBodyModel& model, std::span<const Vec3> points, int particles_per_point,
                         bool along_wall, std::span<const Vec3> normals = {});

/// The point's place now.
inline Vec3 evaluate(const PointBinding& binding, std::size_t i, std::span<const Vec3> x) {
    Vec3 q = Vec3::Zero();
    for (Index k = binding.start[i]; k < binding.start[i + 1]; ++k)
        q += binding.weight[static_cast<std::size_t>(k)] *
             x[static_cast<std::size_t>(binding.particle[static_cast<std::size_t>(k)])];
    return q;
}

/// All points: out has one entry a point.
void evaluate_all(const PointBinding& binding, std::span<const Vec3> x, std::span<Vec3> out, const Workers& workers);

/// Adds a force on point i to the particles' forces, mN.
void add_force(const PointBinding& binding, std::size_t i, const Vec3& force, std::span<Vec3> particle_force);

/// sum w_j^2 c_j of point i, mm/mN: how far the point gives way to a force within one iteration.
double point_compliance(const PointBinding& binding, std::size_t i, std::span<const double> particle_compliance);

}  // namespace cathlab
