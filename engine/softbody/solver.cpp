#include "softbody/solver.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "core/check.h"
#include "softbody/cluster_fit.h"

namespace cathlab {

namespace {

constexpr std::size_t particle_grain = 1024;
constexpr std::size_t group_grain = 8;
constexpr std::size_t shell_grain = 32;  // groups of triangles
constexpr std::size_t piece = 128;       // particles
constexpr std::size_t run_grain = 16;
constexpr Index run_gap = 8;              // particles between two runs that are cheaper to take along than to go round
constexpr double largest_guess_mm = 0.5;  // of a force's share in the start of the first fit

std::size_t at(Index i) {
    return static_cast<std::size_t>(i);
}
const double* numbers(std::span<const Vec3> v) {
    return v.empty() ? nullptr : v.front().data();
}
double* numbers(std::vector<Vec3>& v) {
    return v.empty() ? nullptr : v.front().data();
}
const double* numbers(const std::vector<double>& v) {
    return v.empty() ? nullptr : v.data();
}

bool elastic(const SoftBodyModel& model) {
    return model.form == WallForm::elastic;
}

/// Forces of groups [begin, end) of the shell's triangles at state.x.
void pull(const SoftBodyModel& model, SoftBodyState& state, SoftBodyScratch& scratch, std::size_t begin,
          std::size_t end) {
    const kernel::Elastic view = model.elastic.view(scratch.fibres, numbers(scratch.stiffness_scale),
                                                    scratch.law.empty() ? nullptr : scratch.law.data());
    kernel::best().shell_forces(view, numbers(state.x), scratch.slot_force.data(), state.tangent.data(), begin, end);
}

/// Goals of the shell for particles [begin, end).
void shell_goals(const SoftBodyModel& model, SoftBodyState& state, SoftBodyScratch& scratch, std::size_t begin,
                 std::size_t end) {
    kernel::best().shell_goals(model.elastic.sources(), scratch.slot_force.data(), numbers(state.x),
                               scratch.hold.data(), numbers(scratch.goal), begin, end);
}

void pull_all(const SoftBodyModel& model, SoftBodyState& state, SoftBodyScratch& scratch, const Workers& workers) {
    scratch.slot_force.resize(model.elastic.slots() * 3 * kernel::lanes);
    scratch.goal.resize(model.size());
    workers.for_even_ranges(model.elastic.groups(), shell_grain,
                            [&](std::size_t begin, std::size_t end) { pull(model, state, scratch, begin, end); });
}

/// Fits the clusters, or has the shell pull, as state.x is.
void prepare_goals(const SoftBodyModel& model, SoftBodyState& state, SoftBodyScratch& scratch, const Workers& workers) {
    if (elastic(model)) {
        pull_all(model, state, scratch, workers);
    } else {
        all_to_grid(model, state, scratch, workers);
        fit_all(model, state, scratch, workers);
    }
}

/// Goals of particles [begin, end): of the clusters as they are fitted, or of the shell as it pulls.
void find_goals(const SoftBodyModel& model, SoftBodyState& state, SoftBodyScratch& scratch, std::size_t begin,
                std::size_t end) {
    if (elastic(model))
        shell_goals(model, state, scratch, begin, end);
    else
        gather_goals(model, state, scratch, begin, end);
}

kernel::Particles particles(const SoftBodyModel& model, SoftBodyState& state, SoftBodyScratch& scratch, double h) {
    const std::size_t n = model.size();
    kernel::Particles p{};
    p.mass = model.mass.data();
    p.stiffness = elastic(model) ? numbers(scratch.hold) : model.stiffness.data();
    p.stiffness_scale = elastic(model) ? nullptr : numbers(scratch.stiffness_scale);
    p.support = numbers(scratch.support.empty() ? model.support : scratch.support);
    p.drag = numbers(model.drag);
    p.rest = numbers(model.rest);
    p.fixed = model.fixed.data();
    p.x = numbers(state.x);
    p.v = numbers(state.v);
    p.start = numbers(scratch.start);
    p.predicted = numbers(scratch.predicted);
    p.force = numbers(scratch.force);
    p.compliance = scratch.compliance.data();
    if (scratch.goal.size() == n) {
        p.goal = numbers(scratch.goal);
        p.last_goal = numbers(state.goal);
    }
    p.h = h;
    p.farthest = model.max_speed_mm_s * h;
    p.towards_goal = model.damping_per_s * h / (1.0 + model.damping_per_s * h);
    return p;
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

/// A free body as a rigid one: where its centre of mass is, and what its momentum does to it.
struct RigidMotion {
    Vec3 centre = Vec3::Zero(), velocity = Vec3::Zero(), spin = Vec3::Zero();
};

/// linear, angular (about `origin`): momentum that the body has, or is to get.
RigidMotion rigid_motion(const SoftBodyModel& model, std::span<const Vec3> x, const FreeBody& body, const Vec3& origin,
                         const Vec3& linear, const Vec3& angular) {
    double mass = 0.0;
    Vec3 moment = Vec3::Zero();
    for (const Index i : body.particles) {
        mass += model.mass[at(i)];
        moment += model.mass[at(i)] * (x[at(i)] - origin);
    }
    const Vec3 centre = moment / mass, torque = angular - centre.cross(linear);
    Mat3 inertia = Mat3::Zero();
    for (const Index i : body.particles) {
        const Vec3 r = x[at(i)] - origin - centre;
        inertia += model.mass[at(i)] * (r.squaredNorm() * Mat3::Identity() - r * r.transpose());
    }
    const Eigen::SelfAdjointEigenSolver<Mat3> axes(inertia);
    Vec3 spin = Vec3::Zero();  // a line of particles cannot spin about itself: that axis is left out
    for (int k = 0; k < 3; ++k)
        if (axes.eigenvalues()[k] > 1e-9 * axes.eigenvalues()[2])
            spin += axes.eigenvectors().col(k) * (axes.eigenvectors().col(k).dot(torque) / axes.eigenvalues()[k]);
    return {origin + centre, linear / mass, spin};
}

/// Adds the rigid velocity field that brings the body's momentum to the wanted one.
void restore_momentum(const SoftBodyModel& model, SoftBodyState& state, const FreeBody& body, const Vec3& origin,
                      const Vec3& wanted_linear, const Vec3& wanted_angular) {
    Vec3 linear, angular;
    momentum_of(model, state, body, origin, linear, angular);
    const RigidMotion missing =
        rigid_motion(model, state.x, body, origin, wanted_linear - linear, wanted_angular - angular);
    for (const Index i : body.particles)
        state.v[at(i)] += missing.velocity + missing.spin.cross(state.x[at(i)] - missing.centre);
}

/// Velocities are ways along a chord: a turning body's prediction by them would swell, and in the elastic form, where a
/// particle gives way as if it were heavy, be thrown outwards.  This takes it back to the circle.
void turn_prediction(const SoftBodyModel& model, SoftBodyState& state, SoftBodyScratch& scratch, double h,
                     std::size_t body) {
    const std::vector<Index>& particles = model.free_bodies[body].particles;
    // The state's places are the prediction's by now.
    const Vec3& origin = scratch.start[at(particles.front())];
    const RigidMotion motion = rigid_motion(model, scratch.start, model.free_bodies[body], origin,
                                            scratch.momentum[2 * body], scratch.momentum[2 * body + 1]);
    for (const Index i : particles) {
        const Vec3 inwards = h * h * motion.spin.cross(motion.spin.cross(scratch.start[at(i)] - motion.centre));
        scratch.predicted[at(i)] += inwards;
        state.x[at(i)] += inwards;
    }
}

/// Parts that nothing holds: none where an effect has put tissue around the wall.
std::span<const FreeBody> free_bodies(const SoftBodyModel& model, const SoftBodyScratch& scratch) {
    return scratch.support.empty() ? std::span<const FreeBody>(model.free_bodies) : std::span<const FreeBody>();
}

void predict_with(const SoftBodyModel& model, SoftBodyState& state, SoftBodyScratch& scratch, double h,
                  const SupportMotion* supports, std::span<const Vec3> external_force, const Workers& workers) {
    const std::size_t n = model.size();
    CATHLAB_CHECK(h > 0.0, "a substep must be longer than nothing");
    CATHLAB_CHECK(external_force.empty() || external_force.size() == n, "one external force a particle");
    CATHLAB_CHECK(scratch.stiffness_scale.empty() || scratch.stiffness_scale.size() == n,
                  "one stiffness scale a particle");
    scratch.momentum.resize(2 * model.free_bodies.size());
    for (std::size_t b = 0; b < free_bodies(model, scratch).size(); ++b) {
        const FreeBody& body = model.free_bodies[b];
        momentum_of(model, state, body, state.x[at(body.particles.front())], scratch.momentum[2 * b],
                    scratch.momentum[2 * b + 1]);
    }
    scratch.external_force.assign(external_force.begin(), external_force.end());
    scratch.start.resize(n);
    scratch.force.resize(n);
    scratch.predicted.resize(n);
    scratch.compliance.resize(n);
    if (elastic(model)) {
        scratch.hold.resize(n);
        workers.for_even_ranges(n, particle_grain, [&](std::size_t begin, std::size_t end) {
            hold_now(model.elastic, model.stiffness, state.tangent, scratch.hold, begin, end);
        });
    }
    kernel::Particles walked = particles(model, state, scratch, h);
    if (supports) {
        walked.support_before = numbers(supports->before);
        walked.support_after = numbers(supports->after);
        walked.support_share = supports->share;
    }
    const kernel::Set& set = kernel::best();
    workers.for_even_ranges(n, particle_grain, [&](std::size_t begin, std::size_t end) {
        set.predict(walked, begin, end);
        if (external_force.empty()) return;
        for (std::size_t i = begin; i < end; ++i) {
            if (model.fixed[i]) continue;
            const Vec3 pull = external_force[i] / (model.mass[i] / h / h);
            scratch.predicted[i] += pull;
            // Only a free body has to fall with its forces from the start: a held one would start its fit displaced,
            // and a few passes never take that back.
            if (free_bodies(model, scratch).empty()) continue;
            const double length = pull.norm();
            state.x[i] += length > largest_guess_mm ? Vec3(pull * (largest_guess_mm / length)) : pull;
        }
    });
    if (elastic(model))
        for (std::size_t b = 0; b < free_bodies(model, scratch).size(); ++b)
            turn_prediction(model, state, scratch, h, b);
}

}  // namespace

void visit(Archive& archive, SoftBodyState& state) {
    archive.field("x", state.x);
    archive.field("v", state.v);
    archive.field("goal", state.goal);
    archive.field("rotation", state.rotation);
    if (!state.tangent.empty()) archive.field("tangent", state.tangent);
}

SoftBodyState rest_state(const SoftBodyModel& model) {
    SoftBodyState state;
    state.x = model.rest;
    state.goal = model.rest;
    state.v.assign(model.size(), Vec3::Zero());
    state.rotation.assign(model.group_count() * 4 * kernel::lanes, 0.0);
    for (std::size_t g = 0; g < model.group_count(); ++g)
        std::fill_n(state.rotation.begin() + static_cast<std::ptrdiff_t>(g * 4 * kernel::lanes), kernel::lanes, 1.0);
    state.tangent.assign(model.elastic.groups() * kernel::lanes, 1.0);
    return state;
}

void ask_law(const SoftBodyModel& model, SoftBodyState& state, SoftBodyScratch& scratch, const AskLaw& law,
             const Workers& workers) {
    scratch.law.resize(model.elastic.groups() * 4 * kernel::lanes);
    workers.for_even_ranges(model.elastic.groups(), shell_grain, [&](std::size_t begin, std::size_t end) {
        ask_law(model.shell, model.elastic, scratch.fibres, law, state.x, scratch.law, begin, end);
        for (std::size_t g = begin; g < end; ++g)
            for (std::size_t l = 0; l < kernel::lanes; ++l) {
                double& tangent = state.tangent[g * kernel::lanes + l];
                tangent = std::max(tangent, scratch.law[g * 4 * kernel::lanes + l]);
            }
    });
}

void predict(const SoftBodyModel& model, SoftBodyState& state, SoftBodyScratch& scratch, double h,
             std::span<const Vec3> external_force, const Workers& workers) {
    predict_with(model, state, scratch, h, nullptr, external_force, workers);
}

void predict(const SoftBodyModel& model, SoftBodyState& state, SoftBodyScratch& scratch, double h,
             const SupportMotion& supports, std::span<const Vec3> external_force, const Workers& workers) {
    CATHLAB_CHECK(supports.before.size() == model.size() && supports.after.size() == model.size(),
                  "one displacement a particle");
    predict_with(model, state, scratch, h, &supports, external_force, workers);
}

void solve_goals(const SoftBodyModel& model, SoftBodyState& state, SoftBodyScratch& scratch, const Workers& workers) {
    prepare_goals(model, state, scratch, workers);
    workers.for_even_ranges(model.size(), particle_grain,
                            [&](std::size_t begin, std::size_t end) { find_goals(model, state, scratch, begin, end); });
}

void solve_and_apply(const SoftBodyModel& model, SoftBodyState& state, SoftBodyScratch& scratch, double h, int passes,
                     const Workers& workers) {
    CATHLAB_CHECK(scratch.force.size() == model.size(), "predict comes before");
    const kernel::Set& set = kernel::best();
    const bool on_grid = !elastic(model) && model.precision == Precision::float_;
    for (int pass = 0; pass < passes; ++pass) {
        // From the second pass on, the grid's places come from the walk before.
        if (pass > 0 && on_grid)
            fit_all(model, state, scratch, workers);
        else
            prepare_goals(model, state, scratch, workers);
        const kernel::Particles walked = particles(model, state, scratch, h);
        const bool another = on_grid && pass + 1 < passes;
        workers.for_even_ranges(model.size(), particle_grain, [&](std::size_t begin, std::size_t end) {
            // Piece by piece, so that the goals are still at hand when they are applied.
            for (std::size_t first = begin; first < end; first += piece) {
                const std::size_t last = std::min(first + piece, end);
                find_goals(model, state, scratch, first, last);
                set.apply(walked, first, last);
                if (another) to_grid(state, scratch, first, last);
            }
        });
    }
}

void apply(const SoftBodyModel& model, SoftBodyState& state, SoftBodyScratch& scratch, double h,
           const Workers& workers) {
    CATHLAB_CHECK(scratch.force.size() == model.size() && scratch.goal.size() == model.size(),
                  "predict and solve_goals come before apply");
    const kernel::Particles walked = particles(model, state, scratch, h);
    workers.for_even_ranges(model.size(), particle_grain,
                            [&](std::size_t begin, std::size_t end) { kernel::best().apply(walked, begin, end); });
}

void limit_speed(const SoftBodyModel& model, SoftBodyState& state, const SoftBodyScratch& scratch, double h,
                 std::span<const Index> particles) {
    for (const Index i : particles)
        if (!model.fixed[at(i)])
            kernel::limit_way(scratch.start[at(i)].data(), model.max_speed_mm_s * h, state.x[at(i)].data());
}

namespace {

/// Where `marked` is not 0.
std::vector<std::pair<Index, Index>> runs_of(const std::vector<std::uint8_t>& marked) {
    std::vector<std::pair<Index, Index>> runs;
    const auto end = marked.end();
    for (auto i = marked.begin(); (i = std::find(i, end, 1)) != end;) {
        const auto first = static_cast<Index>(i - marked.begin());
        i = std::find(i, end, 0);
        const auto last = static_cast<Index>(i - marked.begin());
        if (!runs.empty() && first - runs.back().second < run_gap)
            runs.back().second = last;
        else
            runs.emplace_back(first, last);
    }
    return runs;
}

/// The particles that triangles with a touched one see, and all triangles that see one of those: what these particles
/// feel is then known anew.
void grow_part(const ElasticGroups& shell, std::vector<std::uint8_t>& particle, WallPart& part) {
    std::vector<std::uint8_t> group(shell.groups(), 0);
    const auto each_source = [&](std::size_t i, auto&& f) {
        for (std::int32_t k = shell.source_first[i]; k < shell.source_first[i + 1]; ++k) {
            const std::size_t offset = at(shell.source[at(k)]);
            f(at(shell.group_of_slot[offset / (3 * kernel::lanes)]), offset % kernel::lanes);
        }
    };
    for (const auto& [begin, end] : part.touched)
        for (std::size_t i = at(begin); i < at(end); ++i)
            each_source(i, [&](std::size_t g, std::size_t lane) {
                for (std::size_t s = at(shell.first_slot[g]); s < at(shell.first_slot[g + 1]); ++s)
                    particle[at(shell.place[s * kernel::lanes + lane]) / 3] = 1;
            });
    part.runs = runs_of(particle);
    for (const auto& [begin, end] : part.runs)
        for (std::size_t i = at(begin); i < at(end); ++i)
            each_source(i, [&](std::size_t g, std::size_t) { group[g] = 1; });
    for (std::size_t g = 0; g < group.size(); ++g)
        if (group[g]) part.groups.push_back(static_cast<Index>(g));
}

}  // namespace

WallPart part_around(const SoftBodyModel& model, std::span<const Index> touched) {
    std::vector<std::uint8_t> lane(model.group_count() * kernel::lanes, 0), particle(model.size(), 0);
    for (const Index i : touched) particle[at(i)] = 1;
    WallPart part;
    part.touched = runs_of(particle);
    if (elastic(model)) {
        grow_part(model.elastic, particle, part);
        return part;
    }
    for (const auto& [first, last] : part.touched)
        for (Index i = first; i < last; ++i) {
            if (!particle[at(i)]) continue;
            for (Index m = model.cluster_start[at(i)]; m < model.cluster_start[at(i) + 1]; ++m)
                lane[at(model.cluster[at(m)])] = 1;
        }
    const ClusterFit clusters(model);
    for (std::size_t g = 0; g < model.group_count(); ++g) {
        const std::uint8_t* const mine = lane.data() + g * kernel::lanes;
        if (std::all_of(mine, mine + kernel::lanes, [](std::uint8_t m) { return m == 0; })) continue;
        part.groups.push_back(static_cast<Index>(g));
        const std::span<const std::int32_t> places = clusters.places(g);
        for (std::size_t l = 0; l < kernel::lanes; ++l) {
            if (!mine[l]) continue;
            for (std::size_t k = l; k < places.size(); k += kernel::lanes) particle[at(places[k] / 3)] = 1;
        }
    }
    part.runs = runs_of(particle);
    return part;
}

void solve_goals(const SoftBodyModel& model, SoftBodyState& state, SoftBodyScratch& scratch, const WallPart& part,
                 const Workers& workers) {
    CATHLAB_CHECK(scratch.goal.size() == model.size(), "the whole wall is fitted before a part of it");
    if (!elastic(model)) all_to_grid(model, state, scratch, workers);
    const ClusterFit clusters(model);
    workers.for_ranges(part.groups.size(), group_grain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) {
            const std::size_t g = at(part.groups[k]);
            if (elastic(model))
                pull(model, state, scratch, g, g + 1);
            else
                clusters.fit(state, scratch, g, g + 1);
        }
    });
    workers.for_ranges(part.runs.size(), run_grain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k)
            find_goals(model, state, scratch, at(part.runs[k].first), at(part.runs[k].second));
    });
}

void apply(const SoftBodyModel& model, SoftBodyState& state, SoftBodyScratch& scratch, double h, const WallPart& part,
           const Workers& workers) {
    CATHLAB_CHECK(scratch.force.size() == model.size() && scratch.goal.size() == model.size(),
                  "predict and solve_goals come before apply");
    const kernel::Set& set = kernel::best();
    const kernel::Particles walked = particles(model, state, scratch, h);
    workers.for_ranges(part.runs.size(), run_grain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) set.apply(walked, at(part.runs[k].first), at(part.runs[k].second));
    });
}

void apply_touched(const SoftBodyModel& model, SoftBodyState& state, SoftBodyScratch& scratch, double h,
                   const WallPart& part) {
    const kernel::Set& set = kernel::best();
    const kernel::Particles walked = particles(model, state, scratch, h);
    for (const auto& [first, last] : part.touched) set.apply(walked, at(first), at(last));
}

void finish(const SoftBodyModel& model, SoftBodyState& state, SoftBodyScratch& scratch, double h,
            const Workers& workers) {
    if (elastic(model) &&
        model.damping_per_s > 0.0) {  // the velocities go over to those of the clusters' rigid motions here as well
        all_to_grid(model, state, scratch, workers);
        fit_all(model, state, scratch, workers);
        workers.for_even_ranges(model.size(), particle_grain, [&](std::size_t begin, std::size_t end) {
            gather_goals(model, state, scratch, begin, end);
        });
    }
    const kernel::Particles walked = particles(model, state, scratch, h);
    workers.for_even_ranges(model.size(), particle_grain,
                            [&](std::size_t begin, std::size_t end) { kernel::best().finish(walked, begin, end); });
    if (walked.goal) state.goal.swap(scratch.goal);  // the next fit writes all of them anew
    for (std::size_t b = 0; b < free_bodies(model, scratch).size(); ++b) {
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
