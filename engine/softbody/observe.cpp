#include "softbody/observe.h"

#include <algorithm>

#include "core/check.h"

namespace cathlab {

double kinetic_energy(const SoftBodyModel& model, const SoftBodyState& state) {
    double sum = 0.0;
    for (std::size_t i = 0; i < model.size(); ++i) sum += 0.5 * model.mass[i] * state.v[i].squaredNorm();
    return sum;
}

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
        for (std::size_t m = begin; m < end; ++m) {
            const double* t =
                scratch.transform.data() + static_cast<std::size_t>(model.cluster[m]) * kernel::transform_doubles;
            const Eigen::Map<const Mat3, 0, Eigen::OuterStride<4>> rotation(t);
            const Eigen::Map<const Vec3, 0, Eigen::InnerStride<4>> translation(t + 3);
            squares += (state.x[i] - rotation * model.rest[i] - translation).squaredNorm();
        }
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
