#include "step/last_resort.h"

#include "contact/push_out.h"

namespace cathlab {
namespace {

constexpr double pushed_out_mm = 0.2;
// Deeper than this after it, by the nearest wall whatever was known of it, and the wall is folded.
constexpr double folded_mm = 0.26;
// How far beyond it a device's axis may be.
constexpr double look_mm = 2.0;
// So far about what is in a fold the wall goes back ...
constexpr double unfolded_mm = 8.0;
// ... and so far about it samples are looked after.
constexpr double looked_after_mm = 16.0;
// Samples that are worth a thread of their own.
constexpr std::size_t sample_grain = 16;

std::size_t at(Index i) {
    return static_cast<std::size_t>(i);
}

/// Where samples are deep in the nearest wall.
std::vector<Vec3> in_folds(const Parts& p, std::span<const DeviceSample> samples) {
    std::vector<std::uint8_t> folded(samples.size(), 0);
    p.world->workers().for_ranges(samples.size(), sample_grain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const DeviceSample& s = samples[i];
            const SurfacePoint wall = closest(*p.surface, *p.surface_state, s.position, look_mm);
            folded[i] = wall.found() && s.radius - wall.signed_distance > folded_mm ? 1 : 0;
        }
    });
    std::vector<Vec3> places;
    for (std::size_t i = 0; i < samples.size(); ++i)
        if (folded[i] != 0) places.push_back(samples[i].position);
    return places;
}

/// The wall about some places as it was when the substep began, at rest.
void put_back(Parts& p, std::span<const Vec3> places, const TreePart& near) {
    const TreePart part = part_near(p.surface->tree, p.surface_state->boxes, places, unfolded_mm, &near);
    const PointBinding& binding = p.surface->binding;
    for (const Index v : part.vertices)
        for (Index b = binding.start[at(v)]; b < binding.start[at(v) + 1]; ++b) {
            const std::size_t particle = at(binding.particle[at(b)]);
            if (!(p.wall_scratch->compliance[particle] > 0.0)) continue;
            p.wall_state->x[particle] = p.wall_scratch->start[particle];
            p.wall_state->v[particle].setZero();
        }
}

}  // namespace

void take_out_of_wall(Parts& p, std::span<const DeviceSample> samples, const TreePart& near, bool deep) {
    const Workers& workers = p.world->workers();
    const auto push = [&](std::span<const PressedSample> pressed) {
        push_out(*p.surface, near, pressed, samples, pushed_out_mm, p.wall_scratch->compliance, p.wall_state->x,
                 *p.surface_state, workers);
        update(*p.surface, p.wall_state->x, near, *p.surface_state, workers);
    };
    if (deep)
        push(with_rows(*p.contacts));
    else
        update(*p.surface, p.wall_state->x, near, *p.surface_state, workers);
    const std::vector<Vec3> folds = in_folds(p, samples);
    if (folds.empty()) return;
    put_back(p, folds, near);
    std::vector<PressedSample> about;
    for (std::size_t i = 0; i < samples.size(); ++i)
        for (const Vec3& place : folds)
            if ((samples[i].position - place).norm() < looked_after_mm) {
                about.push_back({static_cast<Index>(i)});
                break;
            }
    push(about);
}

}  // namespace cathlab
