#include "softbody/wall_place.h"

#include <algorithm>
#include <numeric>

namespace cathlab {

namespace {

constexpr std::size_t particles_of_place = 12;

}  // namespace

WallPlace wall_place(const SoftBodyModel& wall, const Pose& rest) {
    std::vector<Index> order(wall.rest.size());
    std::iota(order.begin(), order.end(), Index{0});
    const auto count = static_cast<std::ptrdiff_t>(std::min(particles_of_place, order.size()));
    const auto away = [&](Index i) { return (wall.rest[static_cast<std::size_t>(i)] - rest.position).squaredNorm(); };
    std::partial_sort(order.begin(), order.begin() + count, order.end(),
                      [&](Index a, Index b) { return away(a) != away(b) ? away(a) < away(b) : a < b; });
    return {rest, {order.begin(), order.begin() + count}};
}

Pose place_now(const WallPlace& place, const SoftBodyModel& wall, std::span<const Vec3> x) {
    Vec3 moved = Vec3::Zero();
    for (const Index i : place.particles)
        moved += x[static_cast<std::size_t>(i)] - wall.rest[static_cast<std::size_t>(i)];
    Pose now = place.rest;
    if (!place.particles.empty()) now.position += moved / static_cast<double>(place.particles.size());
    return now;
}

}  // namespace cathlab
