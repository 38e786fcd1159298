// One substep of the soft wall: predict, then as often as wanted { solve_goals, apply }, then finish.
//
// Each particle obeys, implicitly,
//     x_i = (m_i/h^2 x~_i + k_i g_i + f_i) / (m_i/h^2 + k_i)          m kg, h s, k mN/mm, f mN
// with x~ the prediction and g the mean of the goals  R_c (X_i - X_c) + x_c  of its clusters.  A force of rows
// therefore moves the particle by its compliance  c_i = 1 / (m_i/h^2 + k_i)  within an iteration, and in equilibrium
// k_i (x_i - g_i) = f_i whatever the step and the number of iterations.  In the wall's elastic form (elastic.h) the
// goals come from a shell's forces, and the clusters are fitted once, at the end, to damp.
#pragma once

#include <span>
#include <utility>
#include <vector>

#include "core/archive.h"
#include "core/parallel.h"
#include "softbody/aligned.h"
#include "softbody/model.h"

namespace cathlab {

struct SoftBodyState {
    std::vector<Vec3> x;           ///< (n) mm, world
    std::vector<Vec3> v;           ///< (n) mm/s
    std::vector<Vec3> goal;        ///< (n) mm, the goals at the end of the last substep (damping)
    std::vector<double> rotation;  ///< (groups x {w, x, y, z} x 8) of the clusters, warm start of their fits
    std::vector<double> tangent;   ///< elastic form: (triangle groups x 8) how much stiffer than at rest each one is
};
void visit(Archive& archive, SoftBodyState& state);

/// What lives within a substep only.
struct SoftBodyScratch {
    std::vector<Vec3> start;           ///< (n) x when the substep began
    std::vector<Vec3> predicted;       ///< (n) x~
    std::vector<Vec3> goal;            ///< (n) g, written by solve_goals
    std::vector<Vec3> force;           ///< (n) mN; rows write here, predict clears
    std::vector<Vec3> external_force;  ///< (n) mN, or empty: what predict was given
    std::vector<double> compliance;    ///< (n) c_i, mm/mN, written by predict; 0 for fixed particles
    std::vector<double>
        stiffness_scale;  ///< (n) factor on k_i, > 0, or empty for 1: effects of the material write it before predict
    std::vector<double> support;      ///< (n) foundation, mN/mm, in place of the model's, or empty: effects write it
    Fibres fibres;                    ///< of the elastic form: an effect of the material writes them before predict
    AlignedVector<double> transform;  ///< fits in double: (lanes x 12) of the clusters
    AlignedVector<std::int32_t> grid,
        grid_transform;                ///< fits in float: (n x 3 + 1) x, (lanes x 12); kernel.h, grid_mm
    std::vector<std::uint8_t> far;     ///< fits in float: (groups) whether sums of transforms may have gone round
    AlignedVector<double> law;         ///< elastic form: (groups x 4 x 8) as ask_law wrote it, or empty
    std::vector<double> hold;          ///< elastic form: (n) k_i now, written by predict
    AlignedVector<double> slot_force;  ///< elastic form: (slots x 3 x 8) of the triangles on their particles
    std::vector<Vec3> momentum;        ///< linear and angular of each free body when the substep began, two each
};

SoftBodyState rest_state(const SoftBodyModel& model);

/// Where supports stand: rest + displacement, on the way from `before` to `after` (n each, mm), share 0 to 1.
struct SupportMotion {
    std::span<const Vec3> before, after;
    double share = 1.0;

    explicit SupportMotion(std::span<const Vec3> from, std::span<const Vec3> to, double part)
        : before(from), after(to), share(part) {}
};

/// Elastic form: asks the membrane's law at every triangle (elastic.h) where the wall is now, for the substep to come.
/// `law` is called from several threads, for different points.  What it says is stiffer at once is held the more firmly
/// from this substep on (state.tangent).
void ask_law(const SoftBodyModel& model, SoftBodyState& state, SoftBodyScratch& scratch, const AskLaw& law,
             const Workers& workers);

/// x~ = x + h v + h^2 f / m, external_force one a particle or empty.  Fixed particles stay where they are, and what
/// surrounds the wall stands as at rest.  Clears scratch.force and writes scratch.compliance.  The first fit starts
/// from x~, except that a force moves this start by 0.5 mm at most: a hard local pull would tear the clusters' fits
/// apart for nothing, and the iteration has the same end from either start.
void predict(const SoftBodyModel& model, SoftBodyState& state, SoftBodyScratch& scratch, double h,
             std::span<const Vec3> external_force, const Workers& workers);

/// The same; fixed particles go to where their supports stand, and what surrounds the wall stands there too.
void predict(const SoftBodyModel& model, SoftBodyState& state, SoftBodyScratch& scratch, double h,
             const SupportMotion& supports, std::span<const Vec3> external_force, const Workers& workers);

/// Fits every cluster to state.x (weights m_i / n_i) and writes scratch.goal.
void solve_goals(const SoftBodyModel& model, SoftBodyState& state, SoftBodyScratch& scratch, const Workers& workers);

/// state.x from x~, goals and scratch.force, no further from the substep's start than model.max_speed_mm_s lets it.
void apply(const SoftBodyModel& model, SoftBodyState& state, SoftBodyScratch& scratch, double h,
           const Workers& workers);

/// solve_goals and apply, `passes` times, in one walk over the particles each.
void solve_and_apply(const SoftBodyModel& model, SoftBodyState& state, SoftBodyScratch& scratch, double h, int passes,
                     const Workers& workers);

/// A part of the wall: the clusters that hold any of some particles, and all particles of those clusters.  Passes after
/// the first need only look here: where nothing touched the wall, it has nothing new to say.  Runs [first, second) are
/// of particles, ascending and apart; they may take in a few neighbours.
struct WallPart {
    std::vector<Index> groups;                     ///< of clusters, ascending
    std::vector<std::pair<Index, Index>> runs;     ///< all particles of the clusters
    std::vector<std::pair<Index, Index>> touched;  ///< the particles given: where forces may change
};
/// touched: particles, in any order, repeats allowed.
WallPart part_around(const SoftBodyModel& model, std::span<const Index> touched);

/// The same for a part: the goals there follow from its clusters as they are fitted now and the others as they were
/// fitted last.
void solve_goals(const SoftBodyModel& model, SoftBodyState& state, SoftBodyScratch& scratch, const WallPart& part,
                 const Workers& workers);
void apply(const SoftBodyModel& model, SoftBodyState& state, SoftBodyScratch& scratch, double h, const WallPart& part,
           const Workers& workers);
/// The same where only forces changed since the last apply.
void apply_touched(const SoftBodyModel& model, SoftBodyState& state, SoftBodyScratch& scratch, double h,
                   const WallPart& part);

/// Brings particles that others have moved back to within what max_speed_mm_s lets them go.  Repeats are possible.
void limit_speed(const SoftBodyModel& model, SoftBodyState& state, const SoftBodyScratch& scratch, double h,
                 std::span<const Index> particles);

/// v = (x - x_start) / h, drawn towards the velocity of the goal, (g - g_last) / h, at the model's damping rate: a
/// rigid motion carries its goals along and is not slowed.  A free body (no fixed particle) gets the linear and angular
/// momentum that it had plus the impulse of its forces: what a fit to a turning body loses in second order of the step
/// is given back.
void finish(const SoftBodyModel& model, SoftBodyState& state, SoftBodyScratch& scratch, double h,
            const Workers& workers);

}  // namespace cathlab
