#include "calibrate/contact_comparison.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/errors.h"

namespace cathlab {
namespace {

double pearson_of(const std::vector<double>& a, const std::vector<double>& b) {
    const auto n = static_cast<double>(a.size());
    double mean_a = 0.0, mean_b = 0.0, ab = 0.0, aa = 0.0, bb = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        mean_a += a[i] / n;
        mean_b += b[i] / n;
    }
    for (std::size_t i = 0; i < a.size(); ++i) {
        ab += (a[i] - mean_a) * (b[i] - mean_b);
        aa += (a[i] - mean_a) * (a[i] - mean_a);
        bb += (b[i] - mean_b) * (b[i] - mean_b);
    }
    return ab / std::sqrt(aa * bb);
}

std::size_t farthest_sample(const Push& push) {
    std::size_t farthest = 0;
    const auto way = [&](std::size_t k) { return (push.ball_mm[k] - push.ball_mm.front()).squaredNorm(); };
    for (std::size_t k = 1; k < push.ball_mm.size(); ++k)
        if (way(k) > way(farthest)) farthest = k;
    return farthest;
}

void check(const MeasuredPush& m) {
    const std::size_t n = m.push.ball_mm.size();
    if (n == 0) throw UserError("contact " + m.name + " has no samples");
    if (m.marker_mm.size() != n || (!m.force_mn.empty() && m.force_mn.size() != n))
        throw UserError("contact " + m.name + ": its columns are not of one length");
}

}  // namespace

ContactComparison compare_contacts(const PushRig& rig, const std::vector<MeasuredPush>& pushes, const Workers& workers,
                                   const std::function<bool()>& on_sample) {
    if (pushes.empty()) throw UserError("there is no contact to compare with");
    for (const MeasuredPush& m : pushes) check(m);
    const PushedWall wall(rig);
    std::vector<PushResult> results(pushes.size());
    workers.for_ranges(pushes.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) results[i] = wall.push(pushes[i].push, on_sample);
    });

    ContactComparison out;
    double place = 0.0, force = 0.0;
    std::size_t forces = 0;
    for (std::size_t i = 0; i < pushes.size(); ++i) {
        const MeasuredPush& m = pushes[i];
        const PushResult& r = results[i];
        if (!r.at_rest) {
            const auto reached =
                std::find_if(r.force_mn.begin(), r.force_mn.end(), [](double f) { return std::isnan(f); });
            throw UserError("contact " + m.name + ": the wall does not come to rest at sample " +
                            std::to_string(reached - r.force_mn.begin() + 1) + " of " +
                            std::to_string(r.force_mn.size()));
        }
        const std::size_t deepest = farthest_sample(m.push);
        PushComparison row;
        row.name = m.name;
        double largest_force = 0.0;
        for (const double f : m.force_mn) largest_force = std::max(largest_force, std::fabs(f));
        for (std::size_t k = 0; k < m.marker_mm.size(); ++k) {
            out.moved_mm.push_back((r.marker_mm[k] - m.push.marker_mm).norm());
            out.measured_mm.push_back((m.marker_mm[k] - m.push.marker_mm).norm());
            const double miss = (r.marker_mm[k] - m.marker_mm[k]).norm();
            place += miss * miss;
            row.largest_miss_mm = std::max(row.largest_miss_mm, miss);
            if (largest_force > 0.0) {
                force += std::pow((r.force_mn[k] - m.force_mn[k]) / largest_force, 2);
                ++forces;
            }
            if (k != deepest) continue;
            row.moved_mm = out.moved_mm.back();
            row.measured_mm = out.measured_mm.back();
            row.force_mn = r.force_mn[k];
            row.measured_force_mn = m.force_mn.empty() ? 0.0 : m.force_mn[k];
        }
        if (largest_force > 0.0)
            out.worst_force = std::max(out.worst_force, std::fabs(row.force_mn / row.measured_force_mn - 1.0));
        out.pushes.push_back(row);
    }
    out.displacement = figures_of(out.moved_mm, out.measured_mm);
    out.place_rmse_mm = std::sqrt(place / static_cast<double>(out.moved_mm.size()));
    out.pearson = pearson_of(out.moved_mm, out.measured_mm);
    constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
    out.force_rms = forces > 0 ? std::sqrt(force / static_cast<double>(forces)) : unknown;
    if (forces == 0) out.worst_force = unknown;
    return out;
}

}  // namespace cathlab
