// All rows between the devices and the wall in one substep, and what they remember from the one before.
//
// In a substep: detect once (after predict), then in every iteration
//     solve_goals; apply_to_wall and apply (the forces so far);   refresh; Rod::solve(chain_rows(device)),
//     solve_kinematic; apply_to_wall and apply (the new forces).
// The first apply matters: a row says how far the wall gives way to a CHANGE of force, so its gap must be measured
// where the wall stands under the forces so far with the new goals, and not at the prediction, which knows neither.
// Leaving it out shakes a wall that is pressed hard.
//
// A row holds sample point p, wall point q = sum w_j x_j, normal n into the lumen:
//     gap = n . (p - q) - offset          mm, offset so that it is signed distance - radius at detection
//     C   = max(sum w_j^2 c_j N_j, min_compliance)                   mm/mN, N_j = see below
//     lambda' = max(0, lambda - gap / C),  |t| <= friction * lambda' mN
// The device gets lambda n + t, particle j gets -w_j (lambda n + t): the weights sum to one and sum w_j x_j = q, so
// force and moment about any point are handed over in full.  N_j, the rows of dynamic
// samples on particle j that carry a force or are closed within 0.1 mm (1 at least), keeps a solve that averages from
// overshooting; it changes how fast the answer is reached and not the answer, which is gap = 0 or lambda = 0.
//
// n is the normal of the smooth wall that the facets stand for (interpolated between corners) where that lies within 60
// degrees of the way to the closest point, else that way: the closest point of a thin wire in its own dent jumps from
// flank to flank of the dent, and a force that turned with it would shake the wall.  For the same reason a sample in a
// dent, a corner or a narrow vessel gets a row for each wall that closes in on it (further_walls): with normals fixed
// for a substep the curvature of the wall would otherwise act one substep late, and a light tip under a large force
// would swing.
//
// Nothing tunnels: a sample at rest or moving at the devices' top speed (100 mm/s: 0.5 mm in a substep of 5 ms; 1 mm
// with the wall coming to meet it) was within that distance of where it is found now, inside.  Rows are made for gaps
// up to `margin` (which must exceed 1 mm: a row that is still open is speculative, it lets the sample come to the
// surface in this substep and no further), and for samples already outside by up to `recovery` on the side they came
// from (closest_point.h, hint).  What moves further in one substep than half the margin is swept: the first triangle
// that its path leaves the lumen through takes the place of the hint, whatever lies behind it.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "contact/closest_point.h"
#include "contact/rows.h"
#include "core/archive.h"
#include "core/parallel.h"

namespace cathlab {

inline constexpr int max_rows_per_sample = 5;

struct ContactSettings {
    double recovery_mm = 4.0;                ///< a sample's centre further outside than this gets no row; > 0
    double min_compliance_mm_per_mn = 1e-4;  ///< a wall that is held rigidly counts as a spring of 10 N/mm; > 0
    double match_mm = 0.5;                   ///< samples whose arc lengths differ by less are the same one
    int rows_per_sample = 5;                 ///< 1 to max_rows_per_sample
    double tip_length_mm = 10.0;             ///< what counts as the tip in the sums
};

/// Sums over the rows of one device.
struct DeviceContact {
    Index device = 0;
    Index active = 0;              ///< rows with a force
    double normal_mn = 0.0;        ///< sum of lambda
    double total_mn = 0.0;         ///< sum of |lambda n + t|
    double tip_mn = 0.0;           ///< the same within tip_length of the tip
    Vec3 force_mn = Vec3::Zero();  ///< net force on the device
    double penetration_mm = 0.0;   ///< largest -gap, >= 0
};

struct ContactReport {
    std::vector<DeviceContact> devices;  ///< ascending; those with a sample
    std::vector<double> region_mn;       ///< sum of |lambda n + t| by region
    Index active = 0;
    double penetration_mm = 0.0;
    double force_imbalance = 0.0;  ///< |forces on devices + forces on particles| / sum |force|; rounding alone
    double moment_imbalance =
        0.0;  ///< the same for moments about the origin, taken at the wall points, / sum |q x force|
};

/// The yielding of a kinematic device's tip, as a spring inside the solve: way = compliance x sum of share x force over
/// its rows, where a sample moves by its share (DeviceSample::yields) of the way.  A cantilever of one shape: force and
/// way belong to each other through the same shares, so that no energy is made.
struct TipYield {
    double compliance_mm_per_mn = 0.0;  ///< 0 = rigid
    double most_mm = 0.0;               ///< of the way
    double most_change_mm = 0.0;        ///< of the way in one substep: what is let go does not jump
    Vec3 start = Vec3::Zero();          ///< the way at the beginning of the substep
    Vec3 way = Vec3::Zero();            ///< the one that the samples' positions hold; on return the new one
};

/// The deepest place that was looked at truly, and the device there.
struct TrueDepth {
    double mm = 0.0;
    Index device = -1;  ///< -1 = none
};

/// What the rows of one sample know of the wall.
WallSeen wall_seen(std::span<const ChainRow> rows);

class ContactSet {
public:
    explicit ContactSet(const ContactSettings& settings = {});

    /// Makes the rows of this substep, sorted by (device, arc length, nearest wall first), warm started from the last
    /// ones. samples: in any order, each (device, arc_mm) once.  margin: mm, > 1 at the default substep (see above).
    /// particles_before, particle_compliance: one a particle, positions at the beginning of the substep (mm) and c_j
    /// (mm/mN).  again: another look in the same substep, so that friction still starts from the forces with which the
    /// substep began.  Throws std::logic_error for samples that are not finite or have no radius.
    void detect(const LumenSurfaceModel& model, const LumenSurfaceState& surface, std::span<const DeviceSample> samples,
                double margin, std::span<const Vec3> particles_before, std::span<const double> particle_compliance,
                const Workers& workers, bool again = false);

    /// Gap, slip and arm of every row from the samples (same number and order as in detect; position, arm and rotation
    /// are read) and the particles where they are now.  Normal, weights and compliance stay.
    void refresh(std::span<const DeviceSample> samples_now, std::span<const Vec3> particles_now,
                 const Workers& workers = Workers());

    /// Deepest penetration among the rows of a device at the last refresh, mm, >= 0.
    double deepest(Index device) const;

    /// How far, mm, device and wall have slid past each other since detect, at the worst row that is closed or nearly
    /// so: its normal and its wall point were true for another place.  Where it is large, detect again.
    double staleness() const;

    /// How deep, mm, >= 0, the samples that carry more than `force_mn`, those of a front end (DeviceSample::walls) more
    /// than `front_mn`, or that lie deep by a row of their own, are in the surface as it is now.  Rows hold the wall's
    /// facets as they lay at detect; under a tip that presses they turn.  Where it is large, detect again.
    TrueDepth true_depth(const LumenSurfaceModel& model, const LumenSurfaceState& surface,
                         std::span<const DeviceSample> samples_now, double force_mn, double front_mn) const;
    /// Where those samples are, neighbours side by side; one with several such rows stands there as often.
    std::vector<Vec3> pressing(std::span<const DeviceSample> samples_now, double force_mn, double front_mn) const;

    /// The rows of one device for the chain solve, contiguous, ascending from the tip; multipliers are in and out.
    std::span<ChainRow> chain_rows(Index device);

    /// What the rows of one sample, from its first one `row` on, know of the wall.
    WallSeen seen_by_sample_of(std::size_t row) const;

    /// Moves the wall (particles, mm) by the change of one device's row forces since `before` (a copy of chain_rows),
    /// each particle by its own compliance: what apply will find, so that the rows can be looked at again at once.
    void yield(Index device, std::span<const ChainRow> before, std::span<Vec3> particles,
               std::span<const double> particle_compliance) const;

    /// Sweeps over the rows of kinematic samples, each seeing what the ones before it did to the wall: particle j gives
    /// way by c_j w_j (change of force), so no averaging by N_j is needed and a dense row of samples converges in a few
    /// sweeps.  particles (mm) move along; the forces that moved them are the ones that apply_to_wall hands out.
    /// tip: where it yields; the samples follow it (follow_tip), which is the caller's to do.
    void solve_kinematic(std::span<const DeviceSample> samples_now, std::span<Vec3> particles,
                         std::span<const double> particle_compliance, int sweeps, TipYield* tip = nullptr);

    /// Adds the particles of the rows that are closed or nearly so at the last refresh; repeats are possible.
    void add_touched(std::vector<Index>& particles) const;

    /// Adds -w_j (lambda n + t) of every row to force (mN, one a particle), in the order of the rows.
    void apply_to_wall(std::span<Vec3> force) const;

    /// Sums of the rows as they are now.  particles: as in the last refresh.
    ContactReport report(std::span<const Vec3> particles) const;

    /// Adds the force on the wall (mN) to out (one a triangle).
    void add_triangle_forces(std::span<Vec3> out) const;

    /// No rows, no memory (a new run).
    void clear();

    std::span<const ChainRow> rows() const { return rows_; }
    std::span<const WallRow> wall_rows() const { return wall_; }
    std::span<const Index> particles() const { return particle_; }
    /// The particles of all rows, each once.
    std::span<const Index> touched() const { return touched_; }
    std::span<const double> weights() const { return weight_; }
    /// Arc lengths, ascending, of the samples of a device that had a row at the last detect.
    std::vector<double> arcs_at_the_wall(Index device) const;
    /// Triangle last seen by sample s of detect, -1 = none.
    Index hint(std::size_t sample) const { return memory_.triangle[sample]; }
    const ContactSettings& settings() const { return settings_; }

    friend void visit(Archive& archive, ContactSet& set);

private:
    bool presses_hard(std::size_t row, std::span<const DeviceSample> samples_now, double force_mn,
                      double front_mn) const;

    /// What a sample leaves behind for the next substep, sorted by (device, arc).
    struct Memory {
        std::vector<std::int64_t> device, first_row;  ///< first_row has one entry more
        std::vector<double> arc;
        std::vector<std::int64_t> place;    ///< of the sample in its span
        std::vector<Index> triangle;        ///< by place
        std::vector<std::int64_t> outside;  ///< by place: 1 = the sample's centre was beyond the wall
    };
    struct Found;

    Found look(const LumenSurfaceModel& model, const LumenSurfaceState& surface, const DeviceSample& sample, Index hint,
               bool known_inside, WallSeen seen, double margin, const NearTriangles& near) const;
    /// Row r: sample `s` (at `place` in its span) against the k-th of the walls that it found.
    void make_row(const LumenSurfaceModel& model, const DeviceSample& s, const Found& found, int k, Index place,
                  std::span<const Vec3> particles_before, std::size_t r);
    void close_ranks();
    void set_compliance(std::span<const double> particle_compliance, const Workers& workers);

    ContactSettings settings_;
    std::vector<ChainRow> rows_;
    std::vector<WallRow> wall_;
    std::vector<Vec3> sample_before_;  ///< by place
    std::vector<Index> particle_;
    std::vector<double> weight_;
    std::vector<std::size_t> room_;  ///< in detect: where the particles of a row begin before they close ranks
    std::vector<Index> touched_;     ///< particle_, each once
    std::vector<Index> touching_;    ///< N_j, one a particle; zero outside set_compliance
    Memory memory_;
};

void visit(Archive& archive, ContactSet& set);

}  // namespace cathlab
