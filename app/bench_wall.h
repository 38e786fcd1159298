// The wall of `cathlab bench wall`: a tube that is pushed about, and what it costs in operations and bytes.
#pragma once

#include <cstddef>
#include <vector>

#include "core/parallel.h"
#include "machine_floor.h"
#include "softbody/model.h"
#include "softbody/solver.h"

namespace cathlab {

inline constexpr int wall_passes = 4;            ///< of { fit, gather, apply } in a step
inline constexpr double wall_step_s = 0.004;     ///< a substep of a scene
inline constexpr double wall_spacing_mm = 2.01;  ///< of particles

/// An open tube of about so many particles, s_c 7.6 mm, r_c 12.3 mm, t_c 0.8: 10,000 particles make 590 clusters of
/// 120. The last 5 mm at both ends are fixed; cluster fits in float.  It is kept in motion, so that no fit finds the
/// rotation that it began with.
class BenchWall {
public:
    explicit BenchWall(std::size_t particles);

    /// predict, wall_passes of { fit, gather, apply }, finish; ms by the clock.
    double step_ms(const Workers& workers);

    const SoftBodyModel& model() const { return model_; }
    /// What pushes it: a velocity a particle, mm/s.  It is added in turns as it stands and reversed.
    const std::vector<Vec3>& push() const { return push_; }

private:
    SoftBodyModel model_;
    SoftBodyState state_;
    SoftBodyScratch scratch_;
    std::vector<Vec3> push_;
    std::size_t steps_ = 0;
};

/// What a step needs, counted from the formulas and not from the code (docs/benchmarks.md has the derivation): padding,
/// comparisons and conversions are no work.  `in_float` what is float, the rest double.
Arithmetic step_operations(const SoftBodyModel& model);

/// Bytes that one pass reads and writes if each array passes by once.
double pass_bytes(const SoftBodyModel& model);

}  // namespace cathlab
