#include "contact/push_out.h"

#include <algorithm>
#include <limits>
#include <map>

namespace cathlab {
namespace {

constexpr int rounds = 12;
constexpr double reach_mm = 6.0;  // a sample's centre further from the wall than this is not in it
// Beside a fixed part the particles that are free have little say in a point.  Less than this share of it, and it
// counts as fixed; with more, none goes further in a round than so many times the way that the point wants, nor in all
// rounds further than so far.
constexpr double least_share = 0.1;
constexpr double farthest = 3.0;
constexpr double most_mm = 4.0;
// A round that leaves something so much deeper than the best one was the last.
constexpr double worse_mm = 0.3;

std::size_t at(Index i) {
    return static_cast<std::size_t>(i);
}

// Moves the wall at a point of a triangle by `way`, as far as its particles are free.  start: where those that have
// been moved lay at first.
void move_wall(const LumenSurfaceModel& model, const SurfacePoint& point, const Vec3& way,
               std::span<const double> particle_compliance, std::span<Vec3> particles, std::map<Index, Vec3>& start) {
    const auto each = [&](const auto& visit) {
        for (int corner = 0; corner < 3; ++corner) {
            const std::size_t v = at(model.triangles[at(point.triangle)][corner]);
            for (Index b = model.binding.start[v]; b < model.binding.start[v + 1]; ++b)
                visit(model.binding.particle[at(b)], point.barycentric[corner] * model.binding.weight[at(b)]);
        }
    };
    double all = 0.0, free = 0.0;
    each([&](Index particle, double weight) {
        all += weight * weight;
        if (particle_compliance[at(particle)] > 0.0) free += weight * weight;
    });
    if (free <= least_share * all) return;
    each([&](Index particle, double weight) {
        if (!(particle_compliance[at(particle)] > 0.0)) return;
        Vec3& x = particles[at(particle)];
        const Vec3& first = start.try_emplace(particle, x).first->second;
        const Vec3 moved = x + std::clamp(weight / free, -farthest, farthest) * way - first;
        const double far = moved.norm();
        x = first + (far > most_mm ? Vec3(most_mm / far * moved) : moved);
    });
}

// Where a point of a triangle is, by the particles.
Vec3 place_of(const LumenSurfaceModel& model, const SurfacePoint& point, std::span<const Vec3> particles) {
    Vec3 place = Vec3::Zero();
    for (int corner = 0; corner < 3; ++corner)
        place += point.barycentric[corner] *
                 evaluate(model.binding, at(model.triangles[at(point.triangle)][corner]), particles);
    return place;
}

}  // namespace

std::vector<PressedSample> with_rows(const ContactSet& contacts) {
    std::vector<PressedSample> out;
    const std::span<const WallRow> rows = contacts.wall_rows();
    for (std::size_t r = 0; r < rows.size(); ++r)
        if (out.empty() || out.back().sample != rows[r].sample)
            out.push_back({rows[r].sample, contacts.hint(at(rows[r].sample)), contacts.seen_by_sample_of(r)});
    return out;
}

double push_out(const LumenSurfaceModel& model, const TreePart& near, std::span<const PressedSample> pressed,
                std::span<const DeviceSample> samples, double depth_mm, std::span<const double> particle_compliance,
                std::span<Vec3> particles, LumenSurfaceState& surface, const Workers& workers) {
    std::map<Index, Vec3> start, best;  // of the particles moved so far: where they lay at first, and in the best round
    double least = std::numeric_limits<double>::infinity();
    for (int round = 0;; ++round) {
        update(model, particles, near, surface, workers);
        double deepest = 0.0;
        std::vector<SurfacePoint> wall;
        for (const PressedSample& one : pressed) {
            const DeviceSample& s = samples[at(one.sample)];
            wall.push_back(closest_credible(model, surface, s.position, reach_mm, one.hint, s.radius, one.seen));
            if (wall.back().found()) deepest = std::max(deepest, s.radius - wall.back().signed_distance);
        }
        if (deepest < least) {
            least = deepest;
            best.clear();
            for (const auto& [particle, first] : start) best.emplace(particle, particles[at(particle)]);
        }
        if (deepest <= depth_mm + 0.01 || round == rounds || deepest > least + worse_mm) break;
        // Neighbours look at the same facets: each moves what the others before it have left.
        for (std::size_t k = 0; k < pressed.size(); ++k) {
            if (!wall[k].found()) continue;
            const Vec3 gone = place_of(model, wall[k], particles) - wall[k].point;
            const double depth =
                samples[at(pressed[k].sample)].radius - wall[k].signed_distance + wall[k].inward_normal.dot(gone);
            if (depth > depth_mm)
                move_wall(model, wall[k], (depth_mm - depth) * wall[k].inward_normal, particle_compliance, particles,
                          start);
        }
    }
    // In a wall that is crumpled up the shortest way out may lead through its other side.
    for (const auto& [particle, first] : start) {
        const auto kept = best.find(particle);
        particles[at(particle)] = kept == best.end() ? first : kept->second;
    }
    return least;
}

}  // namespace cathlab
