// The hot loops on raw arrays, one copy an instruction set.  One lane holds one cluster, and every operation on a lane
// is a plain IEEE one, so the width of the machine's vectors cannot change a bit of the result.
#pragma once

#include <cstddef>
#include <cstdint>

namespace cathlab::kernel {

inline constexpr std::size_t lanes = 8;  ///< clusters in a group
inline constexpr std::size_t transform_numbers =
    12;                                  ///< of a cluster: column k of R, then t_k, three times; goal = R X + t
inline constexpr int polar_rounds = 24;  ///< at most; a warm start ends after two or three

// Fits in float look at places, and say where they take them, in whole steps of a grid.  Eight such numbers fill a
// vector that holds four doubles, they are added without rounding and in any order, and a nanometre is far below what a
// float tells apart at 500 mm.  They count modulo 2^32, 4096 mm: only differences are ever wanted, of particles of one
// cluster or of a goal and its particle.
inline constexpr double grid_mm = 0x1p-20;
inline constexpr double grid_turn_mm = 0x1p32 * grid_mm;
/// Added to a number of less than 2^31 mm, it leaves the steps in the lowest 32 bits of the sum.
inline constexpr double grid_magic = 0x1.8p52 * grid_mm;
/// What the whole numbers of so many rotations may add up to: rotation_unit = rotation_room / their number.
inline constexpr double rotation_room = 0x1p30;

/// ClusterGroups (softbody/model.h) without its vectors.
template <class Real>
struct Groups {
    const std::int32_t* first_slot;
    const std::int32_t* place;
    const Real* member;
    const double* rest_centroid;
    double rotation_unit;  ///< of the fits in float: what 1 stands for in the whole numbers of a transform's R
};

/// steps = numbers in steps of the grid, for numbers [begin, end).
using ToGrid = void (*)(const double* numbers, std::int32_t* steps, std::size_t begin, std::size_t end);
/// Positions (n x 3) as double and, for fits in float, in steps of the grid (n x 3 and one that is read and not used).
struct Positions {
    const double* x;
    const std::int32_t* grid;
};
/// Fits groups [begin, end) to positions: per cluster the centroid x_c, the covariance A = sum w (x - x_c)
/// X^T, its rotation R by iteration from the last one (rotation: groups x {w, x, y, z} x 8, in and out), and transform
/// = (R, x_c - R X_c): doubles, or whole numbers where fits are in float.  far: per group whether a sum of whole t of
/// its clusters may have gone round; may be null for doubles.
using Fit = void (*)(const void* groups, const Positions& positions, double* rotation, void* transform,
                     std::uint8_t* far, std::size_t begin, std::size_t end);
/// GoalSources (softbody/model.h) without its vectors.
struct Goals {
    const std::int32_t* first;
    const std::int32_t* from;
    const double* share;
    double rotation_unit;  ///< as in Groups
};
/// goal_i = mean over its clusters of R X_i + t for particles [begin, end).  x: where they are where sums of whole t
/// may have gone round, else null; a goal is then the one of those 4096 mm over its clusters' number apart that is
/// nearest.
using Gather = void (*)(const Goals& goals, const void* transform, const double* rest, const double* x, double* goal,
                        std::size_t begin, std::size_t end);
/// What a walk over the particles reads and writes (n, or n x 3); what the model does not have is null.
struct Particles {
    const double *mass, *stiffness, *stiffness_scale, *support, *drag, *rest;
    const std::uint8_t* fixed;
    const double *support_before, *support_after;  ///< displacements of the supports; null: they stand as at rest
    double *x, *v, *start, *predicted, *force, *compliance;
    const double *goal, *last_goal;
    double h, support_share, farthest, towards_goal;
};
using Walk = void (*)(const Particles& p, std::size_t begin, std::size_t end);

/// ElasticGroups (softbody/elastic.h) and the fibres of the moment.
inline constexpr std::size_t elastic_constants = 13;
inline constexpr double elastic_least_det = 1e-12;
struct Elastic {
    const std::int32_t* first_slot;
    const std::int32_t* place;
    const double* second;
    const double* constant;
    const double* scale;  ///< (n) factor on all stiffnesses, or null
    const double* law;    ///< (groups x 4 x 8) how many times the membrane's stress, and what is added to it (kPa; 11,
                          ///< 22, 12), or null
    double fibre_stiffness, fibre_exponent, fibre_onset, fibre_limit, fibre_cosine, fibre_sine;
};
/// Forces of triangle groups [begin, end) at x: slot_force (slots x 3 x 8), mN, and tangent (groups x 8), how many
/// times as stiff as at rest a triangle is now.
using ShellForces = void (*)(const Elastic& elastic, const double* x, double* slot_force, double* tangent,
                             std::size_t begin, std::size_t end);
/// Which slots a particle has: slot_force[from[first[i] .. first[i + 1])], the other two axes 8 and 16 further on.
struct ElasticSources {
    const std::int32_t* first;
    const std::int32_t* from;
};
/// goal = x + force / stiffness for particles [begin, end).
using ShellGoals = void (*)(const ElasticSources& sources, const double* slot_force, const double* x,
                            const double* stiffness, double* goal, std::size_t begin, std::size_t end);

/// Takes x back to the ball of radius `farthest` around start (3 numbers each) where it left it.
void limit_way(const double* start, double farthest, double* x);

/// Rotations of eight matrices (9 x 8: a00, a01, .. a22), started from and written to quaternion (4 x 8: w, x, y, z).
using Polar = void (*)(const double* matrix, double* quaternion);

struct Set {
    const char* name;
    Fit fit_double;  ///< groups: Groups<double>
    Fit fit_float;   ///< groups: Groups<float>
    Gather gather_double;
    Gather gather_float;
    ToGrid to_grid;
    Walk predict;  ///< solver.h says what each of the three does
    Walk apply;
    Walk finish;
    ShellForces shell_forces;
    ShellGoals shell_goals;
    Polar polar_double;
    Polar polar_float;
};

/// The widest set that this processor has.
const Set& best();
const Set& baseline();  ///< SSE2
const Set* avx2();      ///< null where the processor lacks it, or FMA

}  // namespace cathlab::kernel
