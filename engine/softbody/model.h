// The recipe of a soft wall, const after load: particles with mass and stiffness, and the overlapping clusters that
// hold them in shape (shape matching, [mueller2005]; clusters along a vessel wall, [li2025]).
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/types.h"
#include "softbody/aligned.h"
#include "softbody/elastic.h"
#include "softbody/kernel.h"
#include "softbody/wall_sample.h"

namespace cathlab {

/// The step at which the cluster stiffness t_c means what it means in the paper [li2025].  A goal stiffness
///     k_i = m_i / reference_step_s^2 * t_c / (1 - t_c)     [mN/mm]
/// makes one pass of the implicit particle form at h = reference_step_s equal the paper's x <- x~ + t_c (g - x~); at
/// any other step or number of passes the stiffness stays k_i.  This number alone maps t_c onto a stiffness with a
/// unit: every k_i goes with its inverse square.  The paper does not tell its solver's inner step.  0.5 ms is the one
/// at which the paper's wall (t_c 0.8, s_c 8 mm, r_c 12 mm) is a human aorta: a tube of radius 12 mm, 1 mm thick and
/// 200 mm long strains under 10 kPa as one of Young's modulus 520 kPa, and gives way to a point load by 0.045 N/mm; 2
/// ms would give 32 kPa and 0.002 N/mm, softer than any artery.  (The aorta's modulus in life is 0.3 to 1 MPa.)
inline constexpr double reference_step_s = 0.5e-3;

/// What one region has of its own; what is empty is the wall's.  A spacing or radius given here is taken as it stands,
/// without the scaling for thin vessels.
struct RegionWall {
    Index region = 0;
    std::optional<double> cluster_spacing_mm, cluster_radius_mm, cluster_stiffness, density_kg_mm3;
    std::optional<double> young_kpa = {}, poisson = {};
};

enum class Precision { float_, double_ };

/// What makes the wall stiff: the paper's clusters by t_c, or an elastic shell by E, nu and its thickness (elastic.h),
/// for which the clusters damp alone.
enum class WallForm { clusters, elastic };

struct WallParameters {
    WallForm form = WallForm::clusters;
    double young_kpa = 500.0;  ///< E at rest, > 0; elastic form
    double poisson = 0.49;     ///< nu, 0 to 0.4999; elastic form
    double density_kg_mm3 = 1.06e-6;
    double cluster_spacing_mm = 8.0;  ///< s_c: a cluster for each s_c^2 of wall
    double cluster_radius_mm = 12.0;  ///< r_c: a cluster holds what lies within r_c along the wall
    double cluster_stiffness = 0.8;   ///< t_c in [0, 0.999]
    double damping_per_s = 5.0;       ///< rate at which a particle's velocity goes over to that of its goal, >= 0
    /// What surrounds the wall holds it like an elastic foundation: a traction of so much per mm of displacement, and
    /// per mm/s of speed, both 0 = nothing around it (a bench phantom).  The foundation stands where the supports of
    /// fixed particles stand.
    double surrounding_kpa_per_mm = 0.0, surrounding_kpa_s_per_mm = 0.0;
    /// No particle goes faster than this: blood and tissue round a thin wall let none snap back at once, > 0.
    double max_speed_mm_s = std::numeric_limits<double>::infinity();
    double reference_spacing_mm =
        2.1;  ///< where particles are denser than this, s_c and r_c shrink with their distance, so
              ///< that a cluster of a coronary holds no more particles than one of the aorta
    Precision precision = Precision::double_;  ///< of the cluster fits; states are double in either
    std::vector<RegionWall> regions;
};

/// Clusters in groups of eight lanes, one lane a cluster, padded with weightless members to the largest of the group.
template <class Real>
struct ClusterGroups {
    std::vector<std::int32_t> first_slot;  ///< (groups + 1) in slots
    AlignedVector<std::int32_t> place;     ///< (slots x 8) index of a particle's x among the coordinates
    AlignedVector<Real> member;  ///< (slots x 4 x 8): w (X - X_c) in x, y, z [kg mm] over cluster weight, w over it
    std::vector<double> rest_centroid;  ///< (groups x 3 x 8) mm
    double rotation_unit = 0.0;         ///< of GoalSources

    std::size_t groups() const { return first_slot.empty() ? 0 : first_slot.size() - 1; }
    kernel::Groups<Real> view() const {
        return {first_slot.data(), place.data(), member.data(), rest_centroid.data(), rotation_unit};
    }
};

/// Whose transforms make a particle's goal: from[first[i] .. first[i + 1]), a multiple of four of them.
struct GoalSources {
    std::vector<std::int32_t> first;  ///< (n + 1)
    std::vector<std::int32_t> from;   ///< in bytes; an empty lane's, which is zero, fills up the four
    std::vector<double> share;        ///< (n) one over the number of clusters
    double rotation_unit = 0.0;  ///< fits in float: 1 in the whole numbers of R, as large as their sums leave room for

    kernel::Goals view() const { return {first.data(), from.data(), share.data(), rotation_unit}; }
};

/// A part of the wall that no fixed particle holds and no cluster ties to another: it keeps its momentum exactly.
struct FreeBody {
    std::vector<Index> particles;
};

struct SoftBodyModel {
    std::vector<Vec3> rest;                      ///< (n) mm
    std::vector<Vec3> normal;                    ///< (n) unit, out of the lumen, at rest
    std::vector<double> area_mm2, thickness_mm;  ///< (n) of the wall that each stands for
    std::vector<double> mass;                    ///< (n) kg
    std::vector<double> stiffness;               ///< (n) k_i, mN/mm; elastic form: at rest
    std::vector<double> support;                 ///< (n) stiffness of what surrounds the wall, mN/mm; empty = none
    std::vector<double> drag;                    ///< (n) its damping, mN s/mm; empty = none
    std::vector<std::uint8_t> fixed;             ///< (n) 1 = follows its support
    std::vector<Index> region;                   ///< (n)
    std::vector<std::pair<Index, Index>> links;  ///< a < b
    double damping_per_s = 0.0;
    double max_speed_mm_s = std::numeric_limits<double>::infinity();

    std::vector<Index> cluster_start;  ///< (n + 1) the clusters of particle i: cluster[cluster_start[i] .. [i+1])
    std::vector<Index> cluster;        ///< lane index = 8 group + lane, ascending for each particle
    GoalSources goals;                 ///< the same for the loop that adds up transforms
    std::size_t cluster_count = 0;     ///< true ones; lanes above them in the last group are empty
    Precision precision = Precision::double_;
    ClusterGroups<double> clusters;       ///< filled where precision is double_
    ClusterGroups<float> clusters_float;  ///< filled where precision is float_
    std::vector<FreeBody> free_bodies;
    WallForm form = WallForm::clusters;
    ShellModel shell;       ///< elastic form
    ElasticGroups elastic;  ///< the same for the solver's loops

    std::size_t size() const { return rest.size(); }
    std::size_t membership_count() const { return cluster.size(); }
    /// Of a lane that belongs to no cluster.
    std::size_t empty_lane() const { return group_count() * kernel::lanes; }
    std::size_t group_count() const { return (cluster_count + kernel::lanes - 1) / kernel::lanes; }
};

/// Builds the wall: mass = density x area x thickness; k_i from t_c (reference_step_s); clusters by blue noise along
/// the links. A cluster holds the particles within r_c of its centre, counted along the links and their diagonals,
/// never through the air. Every fit weighs a particle by its mass over the number of its clusters, so that averaging
/// the goals keeps momentum. Throws UserError where a parameter is out of range, or where the radius leaves particles
/// without a cluster (it names the spacing and the radius that would do).
SoftBodyModel build_soft_body(const WallSample& sample, const WallParameters& parameters,
                              const std::function<bool(const Vec3&)>& is_fixed);

}  // namespace cathlab
