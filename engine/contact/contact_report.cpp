// What the rows add up to: per device, per region, and the check that nothing is lost between devices and wall.
#include <algorithm>

#include "contact/contact_set.h"
#include "core/check.h"

namespace cathlab {

ContactReport ContactSet::report(std::span<const Vec3> particles) const {
    ContactReport report;
    for (const std::int64_t device : memory_.device) {
        if (report.devices.empty() || report.devices.back().device != device) {
            report.devices.emplace_back().device = static_cast<Index>(device);
        }
    }
    Vec3 force = Vec3::Zero(), moment = Vec3::Zero();
    double force_sum = 0.0, moment_sum = 0.0;
    std::size_t d = 0;
    for (std::size_t r = 0; r < rows_.size(); ++r) {
        const ChainRow& row = rows_[r];
        const WallRow& wall = wall_[r];
        while (report.devices[d].device != wall.device) ++d;
        DeviceContact& device = report.devices[d];
        device.penetration_mm = std::max(device.penetration_mm, -row.gap);
        if (row.multiplier == 0.0) continue;
        const Vec3 f = row.multiplier * row.normal + row.tangent_force;
        const double size = f.norm();
        ++device.active;
        device.normal_mn += row.multiplier;
        device.total_mn += size;
        if (wall.arc_mm <= settings_.tip_length_mm) device.tip_mn += size;
        device.force_mn += f;
        if (report.region_mn.size() <= static_cast<std::size_t>(wall.region)) {
            report.region_mn.resize(static_cast<std::size_t>(wall.region) + 1, 0.0);
        }
        report.region_mn[static_cast<std::size_t>(wall.region)] += size;

        const Vec3 turning = wall.point.cross(f);
        force_sum += size;
        moment_sum += turning.norm();
        force += f;
        moment += turning;
        for (std::size_t j = wall.begin; j < wall.end; ++j) {
            const Vec3 share = weight_[j] * f;
            force -= share;
            moment -= particles[static_cast<std::size_t>(particle_[j])].cross(share);
        }
    }
    for (const DeviceContact& device : report.devices) {
        report.active += device.active;
        report.penetration_mm = std::max(report.penetration_mm, device.penetration_mm);
    }
    if (force_sum > 0.0) report.force_imbalance = force.norm() / force_sum;
    if (moment_sum > 0.0) report.moment_imbalance = moment.norm() / moment_sum;
    return report;
}

void ContactSet::add_triangle_forces(std::span<Vec3> out) const {
    for (std::size_t r = 0; r < rows_.size(); ++r) {
        CATHLAB_CHECK(static_cast<std::size_t>(wall_[r].triangle) < out.size(), "one force a triangle");
        out[static_cast<std::size_t>(wall_[r].triangle)] -=
            rows_[r].multiplier * rows_[r].normal + rows_[r].tangent_force;
    }
}

}  // namespace cathlab
