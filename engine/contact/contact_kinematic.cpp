// The rows of a device that does not give way: sweeps in which the wall does.
#include <algorithm>

#include "contact/contact_set.h"

namespace cathlab {
namespace {

std::size_t at(Index i) {
    return static_cast<std::size_t>(i);
}

/// The way of a tip under a generalised force, within its bounds.
Vec3 way_under(const TipYield& tip, const Vec3& force) {
    const Vec3 way = into_cone(tip.compliance_mm_per_mn * force, tip.most_mm);
    return tip.start + into_cone(way - tip.start, tip.most_change_mm);
}

}  // namespace

void ContactSet::solve_kinematic(std::span<const DeviceSample> samples_now, std::span<Vec3> particles,
                                 std::span<const double> particle_compliance, int sweeps, TipYield* tip) {
    const Vec3 held_way = tip ? tip->way : Vec3(Vec3::Zero());
    Vec3 tip_force = Vec3::Zero();
    if (tip) {
        for (std::size_t r = 0; r < rows_.size(); ++r)
            if (wall_[r].kinematic)
                tip_force += samples_now[at(wall_[r].sample)].yields *
                             (rows_[r].multiplier * rows_[r].normal + rows_[r].tangent_force);
        tip->way = way_under(*tip, tip_force);
    }
    for (int sweep = 0; sweep < sweeps; ++sweep)
        for (std::size_t r = 0; r < rows_.size(); ++r) {
            const WallRow& wall = wall_[r];
            if (!wall.kinematic) continue;
            ChainRow& row = rows_[r];
            const DeviceSample& s = samples_now[at(wall.sample)];
            const Vec3 place = tip ? Vec3(s.position + s.yields * (tip->way - held_way)) : s.position;
            Vec3 q = Vec3::Zero();
            double compliance = tip ? s.yields * s.yields * tip->compliance_mm_per_mn : 0.0;
            for (std::size_t j = wall.begin; j < wall.end; ++j) {
                q += weight_[j] * particles[at(particle_[j])];
                compliance += weight_[j] * weight_[j] * particle_compliance[at(particle_[j])];
            }
            // A wall that is held yields like a spring of min_compliance: gap + alpha lambda = 0, whatever the sweeps.
            const double alpha = std::max(0.0, settings_.min_compliance_mm_per_mn - compliance);
            compliance += alpha;
            const double gap = row.normal.dot(place - q) - wall.offset;
            const Vec3 slip =
                tangential(Vec3((place - sample_before_[at(wall.sample)]) - (q - wall.point_before)), row.normal);
            const double multiplier = std::max(0.0, row.multiplier - (gap + alpha * row.multiplier) / compliance);
            const Vec3 now = tangential(row.tangent_force, row.normal);
            const Vec3 tangent =
                into_cone(now - (slip + alpha * (now - row.held)) / compliance, row.friction * multiplier);
            const Vec3 change = (multiplier - row.multiplier) * row.normal + (tangent - row.tangent_force);
            row.multiplier = multiplier;
            row.tangent_force = tangent;
            if (change.isZero(0.0)) continue;
            for (std::size_t j = wall.begin; j < wall.end; ++j) {
                const std::size_t p = at(particle_[j]);
                particles[p] -= particle_compliance[p] * weight_[j] * change;
            }
            if (tip) {
                tip_force += s.yields * change;
                tip->way = way_under(*tip, tip_force);
            }
        }
}

}  // namespace cathlab
