// What can be read off a soft wall without touching it.
#pragma once

#include <span>

#include "softbody/model.h"
#include "softbody/solver.h"

namespace cathlab {

double kinetic_energy(const SoftBodyModel& model, const SoftBodyState& state);  ///< sum m v^2 / 2, uJ
/// sum over particles and their clusters of  k_i / n_i |x_i - (R_c (X_i - X_c) + x_c)|^2 / 2,  uJ, with the fits of the
/// last solve_goals.  Its gradient at those fits is k_i (x_i - g_i).  Elastic form: the shell's energy.
double elastic_energy(const SoftBodyModel& model, const SoftBodyState& state, const SoftBodyScratch& scratch);
Vec3 linear_momentum(const SoftBodyModel& model, const SoftBodyState& state);  ///< sum m v, kg mm/s
Vec3 angular_momentum(const SoftBodyModel& model,
                      const SoftBodyState& state);  ///< sum m x cross v about the origin, kg mm2/s
double largest_displacement(const SoftBodyModel& model, const SoftBodyState& state);  ///< max |x - X|, mm

}  // namespace cathlab
