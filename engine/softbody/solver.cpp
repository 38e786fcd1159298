#include "softbody/solver.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "core/check.h"

namespace cathlab {

namespace {

constexpr std::size_t particle_grain = 1024;
constexpr std::size_t group_grain = 8;
constexpr double largest_guess_mm = 0.5;  // of a force's share in the start of the first fit

std::size_t at(Index i) {
    return static_cast<std::size_t>(i);
}
const double* numbers(const std::vector<Vec3>& v) {
    return v.empty() ? nullptr : v.front().data();
}

double stiffness(const SoftBodyModel& model, const SoftBodyScratch& scratch, std::size_t i) {
    return scratch.stiffness_scale.empty() ? model.stiffness[i] : scratch.stiffness_scale[i] * model.stiffness[i];
}

/// Linear and angular momentum of a free body, the latter about `origin`.
void momentum_of(const SoftBodyModel& model, const SoftBodyState& state, const FreeBody& body, const Vec3& origin,
                 Vec3& linear, Vec3& angular) {
    linear.setZero();
    angular.setZero();
    for (const Index i : body.particles) {
        const Vec3 p = model.mass[at(i)] * state.v[at(i)];
        linear += p;
        angular += (state.x[at(i)] - origin).cross(p);
    }
}

/// Adds the rigid velocity field that brings the body's momentum to the wanted one.
void restore_momentum(const SoftBodyModel& model, SoftBodyState& state, const FreeBody& body, const Vec3& origin,
                      const Vec3& wanted_linear, const Vec3& wanted_angular) {
    Vec3 linear, angular;
    momentum_of(model, state, body, origin, linear, angular);
    double mass = 0.0;
    Vec3 moment = Vec3::Zero();
    for (const Index i : body.particles) {
        mass += model.mass[at(i)];
        moment += model.mass[at(i)] * (state.x[at(i)] - origin);
    }
    const Vec3 centre = moment / mass;
    const Vec3 shift = (wanted_linear - linear) / mass;
    const Vec3 torque = wanted_angular - angular - centre.cross(wanted_linear - linear);
    Mat3 inertia = Mat3::Zero();
    for (const Index i : body.particles) {
        const Vec3 r = state.x[at(i)] - origin - centre;
        inertia += model.mass[at(i)] * (r.squaredNorm() * Mat3::Identity() - r * r.transpose());
    }
    const Eigen::SelfAdjointEigenSolver<Mat3> axes(inertia);
    Vec3 spin = Vec3::Zero();  // a line of particles cannot spin about itself: that axis is left out
    for (int k = 0; k < 3; ++k)
        if (axes.eigenvalues()[k] > 1e-9 * axes.eigenvalues()[2])
            spin += axes.eigenvectors().col(k) * (axes.eigenvectors().col(k).dot(torque) / axes.eigenvalues()[k]);
    for (const Index i : body.particles) state.v[at(i)] += shift + spin.cross(state.x[at(i)] - origin - centre);
}

}  // namespace

void visit(Archive& archive, SoftBodyState& state) {
    archive.field("x", state.x);
    archive.field("v", state.v);
    archive.field("goal", state.goal);
    archive.field("rotation", state.rotation);
}

SoftBodyState rest_state(const SoftBodyModel& model) {
    SoftBodyState state;
    state.x = model.rest;
    state.goal = model.rest;
    state.v.assign(model.size(), Vec3::Zero());
    state.rotation.assign(model.group_count() * 4 * kernel::lanes, 0.0);
    for (std::size_t g = 0; g < model.group_count(); ++g)
        std::fill_n(state.rotation.begin() + static_cast<std::ptrdiff_t>(g * 4 * kernel::lanes), kernel::lanes, 1.0);
    return state;
}

void predict(const SoftBodyModel& model, SoftBodyState& state, SoftBodyScratch& scratch, double h,
             std::span<const Vec3> fixed_target, std::span<const Vec3> external_force, const Workers& workers) {
    const std::size_t n = model.size();
    CATHLAB_CHECK(h > 0.0, "a substep must be longer than nothing");
    CATHLAB_CHECK(fixed_target.empty() || fixed_target.size() == n, "one target a particle");
    CATHLAB_CHECK(external_force.empty() || external_force.size() == n, "one external force a particle");
    CATHLAB_CHECK(scratch.stiffness_scale.empty() || scratch.stiffness_scale.size() == n,
                  "one stiffness scale a particle");
    scratch.momentum.resize(2 * model.free_bodies.size());
    for (std::size_t b = 0; b < model.free_bodies.size(); ++b) {
        const FreeBody& body = model.free_bodies[b];
        momentum_of(model, state, body, state.x[at(body.particles.front())], scratch.momentum[2 * b],
                    scratch.momentum[2 * b + 1]);
    }
    scratch.start = state.x;
    scratch.external_force.assign(external_force.begin(), external_force.end());
    scratch.force.assign(n, Vec3::Zero());
    scratch.predicted.resize(n);
    scratch.compliance.resize(n);
    workers.for_ranges(n, particle_grain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            if (model.fixed[i]) {
                scratch.predicted[i] = fixed_target.empty() ? state.x[i] : fixed_target[i];
                state.x[i] = scratch.predicted[i];
                scratch.compliance[i] = 0.0;
                continue;
            }
            const double inertia = model.mass[i] / (h * h);
            Vec3 coasted = state.x[i] + h * state.v[i];
            scratch.predicted[i] = coasted;
            if (!external_force.empty()) {
                const Vec3 pull = external_force[i] / inertia;
                const double length = pull.norm();
                scratch.predicted[i] += pull;
                // Only a free body has to fall with its forces from the start: a held one would start its fit
                // displaced, and a few passes never take that back.
                if (!model.free_bodies.empty())
                    coasted += length > largest_guess_mm ? Vec3(pull * (largest_guess_mm / length)) : pull;
            }
            // The foundation's springs and dashpots are as implicit as the goals; they go into the right-hand side with
            // x~.
            double around = 0.0;
            if (!model.support.empty()) {
                around += model.support[i];
                const Vec3& stand = fixed_target.empty() ? model.rest[i] : fixed_target[i];
                scratch.predicted[i] += model.support[i] / inertia * stand;
            }
            if (!model.drag.empty()) {
                around += model.drag[i] / h;
                scratch.predicted[i] += model.drag[i] / h / inertia * state.x[i];
            }
            state.x[i] = coasted;
            scratch.compliance[i] = 1.0 / (inertia + around + stiffness(model, scratch, i));
        }
    });
}

void solve_goals(const SoftBodyModel& model, SoftBodyState& state, SoftBodyScratch& scratch, const Workers& workers) {
    const kernel::Set& set = kernel::best();
    const std::size_t groups = model.group_count();
    scratch.transform.resize(groups * kernel::lanes * kernel::transform_doubles);
    scratch.goal.resize(model.size());
    const bool wide = model.precision == Precision::double_;
    const kernel::Groups<double> view = model.clusters.view();
    const kernel::Groups<float> view_float = model.clusters_float.view();
    workers.for_ranges(groups, group_grain, [&](std::size_t begin, std::size_t end) {
        (wide ? set.fit_double : set.fit_float)(wide ? static_cast<const void*>(&view) : &view_float, numbers(state.x),
                                                state.rotation.data(), scratch.transform.data(), begin, end);
    });
    workers.for_ranges(model.size(), particle_grain, [&](std::size_t begin, std::size_t end) {
        set.gather(model.cluster_start.data(), model.cluster.data(), scratch.transform.data(), numbers(model.rest),
                   scratch.goal.front().data(), begin, end);
    });
}

void apply(const SoftBodyModel& model, SoftBodyState& state, SoftBodyScratch& scratch, double h,
           const Workers& workers) {
    CATHLAB_CHECK(scratch.force.size() == model.size() && scratch.goal.size() == model.size(),
                  "predict and solve_goals come before apply");
    workers.for_ranges(model.size(), particle_grain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            if (model.fixed[i]) continue;
            const double inertia = model.mass[i] / (h * h);
            state.x[i] = scratch.compliance[i] * (inertia * scratch.predicted[i] +
                                                  stiffness(model, scratch, i) * scratch.goal[i] + scratch.force[i]);
        }
    });
}

void finish(const SoftBodyModel& model, SoftBodyState& state, SoftBodyScratch& scratch, double h,
            const Workers& workers) {
    const bool has_goals = scratch.goal.size() == model.size();
    const double towards = model.damping_per_s * h / (1.0 + model.damping_per_s * h);
    workers.for_ranges(model.size(), particle_grain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            state.v[i] = (state.x[i] - scratch.start[i]) / h;
            if (!has_goals) continue;
            if (!model.fixed[i]) state.v[i] += towards * ((scratch.goal[i] - state.goal[i]) / h - state.v[i]);
            state.goal[i] = scratch.goal[i];
        }
    });
    for (std::size_t b = 0; b < model.free_bodies.size(); ++b) {
        const FreeBody& body = model.free_bodies[b];
        const Vec3 origin = scratch.start[at(body.particles.front())];
        Vec3 linear = scratch.momentum[2 * b], angular = scratch.momentum[2 * b + 1];
        for (const Index i : body.particles) {
            Vec3 impulse = h * scratch.force[at(i)];
            if (!scratch.external_force.empty()) impulse += h * scratch.external_force[at(i)];
            linear += impulse;
            angular += (scratch.start[at(i)] - origin).cross(impulse);
        }
        restore_momentum(model, state, body, origin, linear, angular);
    }
}

}  // namespace cathlab
