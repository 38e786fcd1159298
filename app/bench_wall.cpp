#include "bench_wall.h"

#include <chrono>

#include "core/deterministic_math.h"
#include "core/units.h"
#include "softbody/tube.h"

namespace cathlab {

namespace {

using Clock = std::chrono::steady_clock;

constexpr std::uint64_t seed = 7;
constexpr double thickness_mm = 1.5;
constexpr double fixed_mm = 5.0;
constexpr std::size_t push_every = 5;  // steps
constexpr double push_mm_s = 40.0;
constexpr double push_wave_mm = 60.0;
constexpr double polar_rounds = 2.0;  // one that lands and one that finds that it has

SoftBodyModel build(std::size_t particles) {
    const TubeShape shape = tube_for(particles, wall_spacing_mm);
    WallParameters parameters;
    parameters.reference_spacing_mm = 0.5 * wall_spacing_mm;  // s_c and r_c as they stand
    parameters.cluster_spacing_mm = 7.6;
    parameters.cluster_radius_mm = 12.3;
    parameters.precision = Precision::float_;
    return build_soft_body(tube_sample(shape, wall_spacing_mm, thickness_mm, seed), parameters,
                           [&](const Vec3& p) { return p.z() < fixed_mm || p.z() > shape.length_mm - fixed_mm; });
}

}  // namespace

BenchWall::BenchWall(std::size_t particles) : model_(build(particles)), state_(rest_state(model_)) {
    push_.reserve(model_.size());
    for (std::size_t i = 0; i < model_.size(); ++i) {
        const double wave = det::sin(2.0 * units::pi * model_.rest[i].z() / push_wave_mm);
        push_.push_back(model_.fixed[i] ? Vec3::Zero() : Vec3(push_mm_s * wave * model_.normal[i]));
    }
}

double BenchWall::step_ms(const Workers& workers) {
    if (steps_ % push_every == 0) {
        const double turn = steps_ / push_every % 2 == 0 ? 1.0 : -1.0;
        for (std::size_t i = 0; i < push_.size(); ++i) state_.v[i] += turn * push_[i];
    }
    ++steps_;
    const auto begin = Clock::now();
    predict(model_, state_, scratch_, wall_step_s, {}, workers);
    solve_and_apply(model_, state_, scratch_, wall_step_s, wall_passes, workers);
    finish(model_, state_, scratch_, wall_step_s, workers);
    return std::chrono::duration<double, std::milli>(Clock::now() - begin).count();
}

Arithmetic step_operations(const SoftBodyModel& model) {
    const auto memberships = static_cast<double>(model.membership_count());
    const auto clusters = static_cast<double>(model.cluster_count);
    const auto particles = static_cast<double>(model.size());
    Arithmetic pass;
    // Each membership: d = x - o; c += w d, A += d X^T; and twelve numbers of R and t added up for the goal.
    pass.in_double += memberships * Operations{0.0, 3.0 + 12.0};
    pass.in_float += memberships * Operations{3.0 + 9.0, 3.0 + 9.0};
    // Each cluster: scaling A, the rounds (R of q, R^T A, its axial vector, the symmetric part's adjugate, the turn,
    // the new q at unit length), R of q; then t = x_c - R X_c.
    pass.in_float +=
        clusters * (Operations{9.0, 0.0} + polar_rounds * Operations{103.0, 79.0} + Operations{17.0, 15.0});
    pass.in_double += clusters * Operations{9.0, 12.0};
    // Each particle: g = share (R X + t); x = c (m/h^2 x~ + k g + f), and how far that is from the start.
    pass.in_double += particles * (Operations{13.0, 9.0} + Operations{10.0, 9.0});
    Arithmetic step{wall_passes * pass.in_float, wall_passes * pass.in_double};
    // Once a step: x~ = x + h v and the compliance; v = (x - start) / h drawn towards the goal's.
    step.in_double += particles * (Operations{6.0, 5.0} + Operations{9.0, 12.0});
    return step;
}

double pass_bytes(const SoftBodyModel& model) {
    const auto memberships = static_cast<double>(model.membership_count());
    const auto clusters = static_cast<double>(model.cluster_count);
    const auto particles = static_cast<double>(model.size());
    // Fit: particle and four floats of a membership; x; rotation in and out, centroid at rest, transform of a cluster.
    const double fit = memberships * (4.0 + 16.0) + particles * 24.0 + clusters * (2.0 * 32.0 + 24.0 + 96.0);
    // Gather: transform of a membership; transforms; where a particle's begin, their share, its rest place, its goal.
    const double gather = memberships * 4.0 + clusters * 96.0 + particles * (4.0 + 8.0 + 24.0 + 24.0);
    // Apply: x out, start, x~, force; mass, stiffness, compliance, fixed.  (The goal is still at hand.)
    const double apply = particles * (24.0 + 3.0 * 24.0 + 3.0 * 8.0 + 1.0);
    return fit + gather + apply;
}

}  // namespace cathlab
