#include "softbody/observe.h"

#include <algorithm>
#include <cmath>

#include "core/check.h"

namespace cathlab {

double kinetic_energy(const SoftBodyModel& model, const SoftBodyState& state) {
    double sum = 0.0;
    for (std::size_t i = 0; i < model.size(); ++i) sum += 0.5 * model.mass[i] * state.v[i].squaredNorm();
    return sum;
}

namespace {

/// x less the goal that a cluster has for the particle that rests at X, mm.
Vec3 off_goal(const SoftBodyModel& model, const SoftBodyScratch& scratch, std::size_t cluster, const Vec3& rest,
              const Vec3& x) {
    const std::size_t first = cluster * kernel::transform_numbers;
    if (model.precision == Precision::double_) {
        const double* t = scratch.transform.data() + first;
        return x - Eigen::Map<const Mat3, 0, Eigen::OuterStride<4>>(t) * rest -
               Eigen::Map<const Vec3, 0, Eigen::InnerStride<4>>(t + 3);
    }
    const std::int32_t* t = scratch.grid_transform.data() + first;
    Vec3 off = x;
    for (Index k = 0; k < 3; ++k) {
        for (Index j = 0; j < 3; ++j) off[k] -= t[4 * j + k] / model.goals.rotation_unit * rest[j];
        off[k] -= kernel::grid_mm * t[4 * k + 3];
        off[k] -= kernel::grid_turn_mm * std::round(off[k] / kernel::grid_turn_mm);
    }
    return off;
}

}  // namespace

double elastic_energy(const SoftBodyModel& model, const SoftBodyState& state, const SoftBodyScratch& scratch) {
    if (model.form == WallForm::elastic) {
        CATHLAB_CHECK(scratch.stiffness_scale.empty(), "the energy of a scaled shell is not told");
        return shell_energy(model.shell, state.x, scratch.fibres);
    }
    double sum = 0.0;
    for (std::size_t i = 0; i < model.size(); ++i) {
        const double scale = scratch.stiffness_scale.empty() ? 1.0 : scratch.stiffness_scale[i];
        const auto begin = static_cast<std::size_t>(model.cluster_start[i]);
        const auto end = static_cast<std::size_t>(model.cluster_start[i + 1]);
        double squares = 0.0;
        for (std::size_t m = begin; m < end; ++m)
            squares += off_goal(model, scratch, static_cast<std::size_t>(model.cluster[m]), model.rest[i], state.x[i])
                           .squaredNorm();
        sum += 0.5 * scale * model.stiffness[i] * squares / static_cast<double>(end - begin);
    }
    return sum;
}

Vec3 linear_momentum(const SoftBodyModel& model, const SoftBodyState& state) {
    Vec3 sum = Vec3::Zero();
    for (std::size_t i = 0; i < model.size(); ++i) sum += model.mass[i] * state.v[i];
    return sum;
}

Vec3 angular_momentum(const SoftBodyModel& model, const SoftBodyState& state) {
    Vec3 sum = Vec3::Zero();
    for (std::size_t i = 0; i < model.size(); ++i) sum += model.mass[i] * state.x[i].cross(state.v[i]);
    return sum;
}

double largest_displacement(const SoftBodyModel& model, const SoftBodyState& state) {
    double largest = 0.0;
    for (std::size_t i = 0; i < model.size(); ++i) largest = std::max(largest, (state.x[i] - model.rest[i]).norm());
    return largest;
}

}  // namespace cathlab
