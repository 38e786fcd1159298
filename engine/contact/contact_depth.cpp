// How deep what presses truly lies in the wall.
#include <algorithm>

#include "contact/contact_set.h"

namespace cathlab {
namespace {

// What its own row puts deeper than this is looked at truly: in a crumpled wall a row reads up to 0.15 mm too little.
constexpr double looks_deep_mm = 0.15;

std::size_t at(Index i) {
    return static_cast<std::size_t>(i);
}

}  // namespace

bool ContactSet::presses_hard(std::size_t r, std::span<const DeviceSample> samples_now, double force_mn,
                              double front_mn) const {
    if (rows_[r].multiplier > (samples_now[at(wall_[r].sample)].walls > 0 ? front_mn : force_mn)) return true;
    return rows_[r].gap < -looks_deep_mm;
}

std::vector<Vec3> ContactSet::pressing(std::span<const DeviceSample> samples_now, double force_mn,
                                       double front_mn) const {
    std::vector<Vec3> places;
    for (std::size_t r = 0; r < rows_.size(); ++r)
        if (presses_hard(r, samples_now, force_mn, front_mn))
            places.push_back(samples_now[at(wall_[r].sample)].position);
    return places;
}

WallSeen wall_seen(std::span<const ChainRow> rows) {
    WallSeen seen{0.0, Vec3::Zero()};
    double strongest = 0.0;
    for (const ChainRow& row : rows) {
        seen.depth_mm = std::max(seen.depth_mm, -row.gap);
        if (row.multiplier <= strongest) continue;
        strongest = row.multiplier;
        seen.pressed_by = row.normal;
    }
    return seen;
}

WallSeen ContactSet::seen_by_sample_of(std::size_t row) const {
    std::size_t end = row;
    while (end < rows_.size() && wall_[end].sample == wall_[row].sample) ++end;
    return wall_seen(std::span(rows_).subspan(row, end - row));
}

TrueDepth ContactSet::true_depth(const LumenSurfaceModel& model, const LumenSurfaceState& surface,
                                 std::span<const DeviceSample> samples_now, double force_mn, double front_mn) const {
    TrueDepth deepest;
    Index last = -1;
    for (std::size_t r = 0; r < rows_.size(); ++r) {
        if (wall_[r].sample == last || !presses_hard(r, samples_now, force_mn, front_mn)) continue;
        const DeviceSample& s = samples_now[at(wall_[r].sample)];
        last = wall_[r].sample;
        const SurfacePoint nearest = closest_credible(model, surface, s.position, settings_.recovery_mm,
                                                      memory_.triangle[at(last)], s.radius, seen_by_sample_of(r));
        const double depth = nearest.found() ? s.radius - nearest.signed_distance : 0.0;
        if (depth > deepest.mm) deepest = {depth, s.device};
    }
    return deepest;
}

}  // namespace cathlab
