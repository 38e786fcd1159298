// Random full-speed operation in a rigid vessel whose wall is known in closed form: a union of round cones along a
// fork.
#include <gtest/gtest.h>

#include <cmath>

#include "catheter/route.h"
#include "catheter/wall_limit.h"
#include "core/random.h"
#include "core/units.h"

using namespace cathlab;

namespace {

struct Vessel {
    CentrelineGraph graph;
    std::vector<Vec3> positions;

    Index run(Index from, const Vec3& heading, const Vec3& turn, int count, double radius) {
        Vec3 direction = heading.normalized();
        for (int i = 0; i < count; ++i) {
            direction = (direction + turn).normalized();
            const Vec3 before = from < 0 ? Vec3(Vec3::Zero()) : graph.nodes[static_cast<std::size_t>(from)].position;
            graph.nodes.push_back({from < 0 ? before : Vec3(before + 2.0 * direction), radius, 0});
            const auto index = static_cast<Index>(graph.nodes.size() - 1);
            if (from >= 0) graph.edges.emplace_back(from, index);
            from = index;
        }
        return from;
    }
    // A curved trunk that divides into two branches.
    static Vessel fork() {
        Vessel v;
        const Index trunk =
            v.run(v.run(-1, Vec3::UnitZ(), Vec3::Zero(), 60, 9.0), Vec3::UnitZ(), Vec3(0.05, 0, 0), 40, 9.0);
        v.run(trunk, Vec3(1, 0, 1), Vec3::Zero(), 60, 6.0);
        v.run(trunk, Vec3(0.3, 1, 0.2), Vec3::Zero(), 60, 5.0);
        for (const CentrelineNode& node : v.graph.nodes) v.positions.push_back(node.position);
        return v;
    }
    // Distance to the wall (positive inside) and the direction away from it.
    double gap(const Vec3& p, Vec3& inward) const {
        double best = -1e9;
        for (const auto& [a, b] : graph.edges) {
            const Vec3& s = positions[static_cast<std::size_t>(a)];
            const Vec3 e = positions[static_cast<std::size_t>(b)] - s;
            const double t = std::clamp((p - s).dot(e) / e.squaredNorm(), 0.0, 1.0);
            const double radius = graph.nodes[static_cast<std::size_t>(a)].radius * (1 - t) +
                                  graph.nodes[static_cast<std::size_t>(b)].radius * t;
            const Vec3 off = s + t * e - p;
            if (radius - off.norm() > best) {
                best = radius - off.norm();
                inward = off.norm() > 1e-9 ? Vec3(off.normalized()) : Vec3(Vec3::UnitX());
            }
        }
        return best;
    }
};

}  // namespace

TEST(CatheterDrive, RandomFullSpeedOperationNeverLeavesARigidVessel) {
    const Vessel vessel = Vessel::fork();
    const CatheterSpec spec;
    const RouteGraph graph = build_route_graph(vessel.graph, 0, Pose{});
    const double h = 0.004;
    double deepest = 0.0, farthest = 0.0;
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
        CatheterState state = initial_state(spec, 10.0);
        CatheterCommand command;
        update_route(graph, vessel.positions, {}, base_arc_mm(spec, state), state.route);
        CatheterShape now = shape(spec, state, build_rail(graph, vessel.positions, state.route, Pose{}));
        for (int step = 0; step < 1500; ++step) {
            if (step % 100 == 0) {
                const auto random = [&](std::uint64_t k) {
                    return random_uniform(seed, RandomStream::test, static_cast<std::uint64_t>(step), k);
                };
                command.advance_mm = (random(0) < 0.7 ? 100.0 : -100.0) * h;
                command.rotate_rad = (2.0 * random(1) - 1.0) * 360.0 * units::deg * h;
                command.bend_rad = {random(2) * 60.0 * units::deg, random(3) * 140.0 * units::deg};
                command.direction_rad = {random(4) * 6.0, random(5) * 6.0};
            }
            update_route(graph, vessel.positions, steering_guide(spec, now), base_arc_mm(spec, state), state.route);
            const Rail rail = build_rail(graph, vessel.positions, state.route, Pose{});
            now = shape(spec, state, rail);
            std::vector<WallLimit> limits;
            for (std::size_t i = 0; i < now.points.size(); ++i) {
                WallLimit limit;
                limit.point = static_cast<Index>(i);
                limit.gap = vessel.gap(now.points[i], limit.normal) - spec.radius_mm();
                limit.penetration_limit = spec.penetration_limit_mm;
                if (now.arc[i] > 3.0) deepest = std::max(deepest, -limit.gap);
                if (limit.gap < 2.0) limits.push_back(limit);
            }
            const double end = insertion_limit(graph, vessel.positions, state.route, spec.steerable_length_mm());
            const CatheterTaken taken = take(spec, state, command, rail, limits, h, end);
            state = taken.state;
            now = taken.shape;
            ASSERT_TRUE(now.tip.position.allFinite());
            ASSERT_GE(taken.refused, 0.0);
            ASSERT_LE(taken.refused, 1.0);
            farthest = std::max(farthest, state.insertion_mm);
        }
    }
    RecordProperty("deepest_mm", std::to_string(deepest));
    RecordProperty("farthest_mm", std::to_string(farthest));
    EXPECT_GT(farthest, 150.0);
    EXPECT_LT(deepest, 0.5);
}
