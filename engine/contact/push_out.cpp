#include "contact/push_out.h"

#include <algorithm>

namespace cathlab {
namespace {

constexpr int rounds = 12;
constexpr double reach_mm = 6.0;  // a sample's centre further from the wall than this is not in it

std::size_t at(Index i) {
    return static_cast<std::size_t>(i);
}

// Moves the wall at a point of a triangle by `way`, as far as its particles are free.
void move_wall(const LumenSurfaceModel& model, const SurfacePoint& point, const Vec3& way,
               std::span<const double> particle_compliance, std::span<Vec3> particles) {
    const auto each = [&](const auto& visit) {
        for (int corner = 0; corner < 3; ++corner) {
            const std::size_t v = at(model.triangles[at(point.triangle)][corner]);
            for (Index b = model.binding.start[v]; b < model.binding.start[v + 1]; ++b) {
                const Index particle = model.binding.particle[at(b)];
                if (particle_compliance[at(particle)] > 0.0)
                    visit(particle, point.barycentric[corner] * model.binding.weight[at(b)]);
            }
        }
    };
    double squared = 0.0;
    each([&](Index, double weight) { squared += weight * weight; });
    if (squared < 1e-6) return;
    each([&](Index particle, double weight) { particles[at(particle)] += weight / squared * way; });
}

}  // namespace

double push_out(const LumenSurfaceModel& model, const TreePart& near, const ContactSet& contacts,
                std::span<const DeviceSample> samples, double depth_mm, std::span<const double> particle_compliance,
                std::span<Vec3> particles, LumenSurfaceState& surface, const Workers& workers) {
    std::vector<Index> touching;
    for (const WallRow& row : contacts.wall_rows())
        if (touching.empty() || touching.back() != row.sample) touching.push_back(row.sample);
    double deepest = 0.0;
    for (int round = 0; round < rounds; ++round) {
        update(model, particles, near, surface, workers);
        deepest = 0.0;
        for (const Index s : touching) {
            const DeviceSample& sample = samples[at(s)];
            const SurfacePoint wall = closest(model, surface, sample.position, reach_mm, contacts.hint(at(s)));
            if (!wall.found()) continue;
            const double depth = sample.radius - wall.signed_distance;
            deepest = std::max(deepest, depth);
            if (depth > depth_mm)
                move_wall(model, wall, (depth_mm - depth) * wall.inward_normal, particle_compliance, particles);
        }
        if (deepest <= depth_mm + 0.01) break;
    }
    return deepest;
}

}  // namespace cathlab
