#include "catheter/route.h"

#include <gtest/gtest.h>

#include <cmath>

#include "catheter/shape.h"
#include "core/errors.h"
#include "core/units.h"

using namespace cathlab;

namespace {

struct Tree {
    CentrelineGraph graph;
    std::vector<Vec3> positions() const {
        std::vector<Vec3> out;
        for (const auto& node : graph.nodes) out.push_back(node.position);
        return out;
    }
    Index add(const Vec3& p, double radius, Index from) {
        graph.nodes.push_back({p, radius, 0});
        const auto index = static_cast<Index>(graph.nodes.size() - 1);
        if (from >= 0) graph.edges.emplace_back(from, index);
        return index;
    }
    // A straight run of nodes 2 mm apart; returns the last.
    Index run(Index from, const Vec3& direction, double length, double radius) {
        const Vec3 step = 2.0 * direction.normalized();
        for (double s = 0.0; s < length - 1e-9; s += 2.0)
            from = add(graph.nodes[static_cast<std::size_t>(from)].position + step, radius, from);
        return from;
    }
};

// A trunk along z for 100 mm that divides into +x and -x at 40 degrees from the axis.
Tree fork(Index& left_end, Index& right_end) {
    Tree tree;
    const Index trunk = tree.run(tree.add(Vec3::Zero(), 8.0, -1), Vec3::UnitZ(), 100.0, 8.0);
    const double a = 40.0 * units::deg;
    left_end = tree.run(trunk, Vec3(std::sin(a), 0.0, std::cos(a)), 120.0, 5.0);
    right_end = tree.run(trunk, Vec3(-std::sin(a), 0.0, std::cos(a)), 120.0, 5.0);
    return tree;
}

}  // namespace

TEST(CatheterRoute, SteeringPicksTheBranchAndWithdrawingForgetsIt) {
    Index left = 0, right = 0;
    const Tree tree = fork(left, right);
    const auto positions = tree.positions();
    const RouteGraph graph = build_route_graph(tree.graph, 0, Pose{});
    const CatheterSpec spec;
    for (const double direction : {0.0, units::pi}) {
        CatheterState state = initial_state(spec, 0.0);
        for (double insertion = 0.0; insertion < 220.0; insertion += 0.5) {
            state.insertion_mm = insertion;
            state.bend_rad = {30.0 * units::deg, 10.0 * units::deg};
            state.direction_rad = {direction, direction};
            const CatheterSpec& s = spec;
            if (state.route.empty()) update_route(graph, positions, {}, base_arc_mm(s, state), state.route);
            const Rail rail = build_rail(graph, positions, state.route, Pose{});
            const auto guide = steering_guide(spec, shape(spec, state, rail));
            update_route(graph, positions, guide, base_arc_mm(spec, state), state.route);
        }
        const double x = positions[static_cast<std::size_t>(state.route.back())].x();
        EXPECT_GT(direction == 0.0 ? x : -x, 10.0);
        update_route(graph, positions, {}, 40.0, state.route);
        EXPECT_EQ(state.route.back(), 35);  // 70 mm = base + look-ahead, before the fork at node 50
    }
}

TEST(CatheterRoute, ALoopDoesNotSendTheRouteBackwards) {
    // Trunk, then a ring with two ways round (the second longer), then onward.
    Tree tree;
    const Index in = tree.run(tree.add(Vec3::Zero(), 4.0, -1), Vec3::UnitZ(), 60.0, 4.0);
    const auto side = [&](double sign, double bulge) {
        Index from = in;
        const Vec3 start = tree.graph.nodes[static_cast<std::size_t>(in)].position;
        for (int i = 1; i < 20; ++i) {
            const double t = i / 20.0;
            from = tree.add(start + Vec3(sign * bulge * std::sin(units::pi * t), 0.0, 40.0 * t), 3.0, from);
        }
        return from;
    };
    const Index a = side(1.0, 8.0), b = side(-1.0, 16.0);
    const Index out = tree.add(Vec3(0.0, 0.0, 100.0), 4.0, a);
    tree.graph.edges.emplace_back(b, out);
    const Index end = tree.run(out, Vec3::UnitZ(), 100.0, 4.0);
    const auto positions = tree.positions();
    const RouteGraph graph = build_route_graph(tree.graph, 0, Pose{});
    for (const double lean : {1.0, -1.0}) {  // whichever side the guide leans to
        std::vector<std::int64_t> route;
        const std::vector<Vec3> guide = {Vec3(0, 0, 50), Vec3(lean * 14.0, 0, 80), Vec3(lean * 14.0, 0, 70)};
        update_route(graph, positions, guide, 400.0, route);
        EXPECT_EQ(route.back(), end);
        for (std::size_t i = 1; i < route.size(); ++i)
            EXPECT_GT(positions[static_cast<std::size_t>(route[i])].z(),
                      positions[static_cast<std::size_t>(route[i - 1])].z() - 1e-9);
        EXPECT_EQ(positions[static_cast<std::size_t>(route[40])].x() > 0.0, lean > 0.0);
    }
}

TEST(CatheterRoute, InsertionEndsWhereTheGraphEnds) {
    Index left = 0, right = 0;
    const Tree tree = fork(left, right);
    const auto positions = tree.positions();
    const RouteGraph graph = build_route_graph(tree.graph, 0, Pose{});
    std::vector<std::int64_t> route;
    update_route(graph, positions, {}, 10.0, route);
    EXPECT_NEAR(insertion_limit(graph, positions, route, 1000.0), 220.0, 1e-9);
    update_route(graph, positions, {}, 500.0, route);
    EXPECT_NEAR(insertion_limit(graph, positions, route, 100.0), 220.0, 1e-9);
}

TEST(CatheterRoute, AnEntryWithoutAVesselIsTheUsersError) {
    Tree tree;
    tree.add(Vec3::Zero(), 4.0, -1);
    EXPECT_THROW(build_route_graph(tree.graph, 0, Pose{}), UserError);
}

TEST(CatheterRail, AChangeAtTheRoutesEndDoesNotMoveTheBase) {
    Index left = 0, right = 0;
    const Tree tree = fork(left, right);
    const auto positions = tree.positions();
    const RouteGraph graph = build_route_graph(tree.graph, 0, Pose{});
    std::vector<std::int64_t> one, other;
    const double base = 71.0;  // the fork, at 100 mm, has just come into the look-ahead
    update_route(graph, positions, std::vector<Vec3>{{50, 0, 150}}, base, one);
    update_route(graph, positions, std::vector<Vec3>{{-50, 0, 150}}, base, other);
    ASSERT_NE(one.back(), other.back());
    const Rail a = build_rail(graph, positions, one, Pose{}), b = build_rail(graph, positions, other, Pose{});
    EXPECT_LT((a.at(base).position - b.at(base).position).norm(), 1e-9);
    EXPECT_LT((a.at(base).orientation.coeffs() - b.at(base).orientation.coeffs()).norm(), 1e-9);
    EXPECT_LT(rail_support_mm(RailShape{}), route_lookahead_mm);
}

TEST(CatheterRail, CornersAreRoundedAndTheRailStaysNearTheCentre) {
    std::vector<Vec3> nodes;
    for (int i = 0; i <= 30; ++i) nodes.emplace_back(0.0, 0.0, 2.0 * i);
    for (int i = 1; i <= 30; ++i) nodes.emplace_back(2.0 * i, 0.0, 60.0);
    const std::vector<double> radius(nodes.size(), 6.0);
    const RailShape options;
    const Rail rail = build_rail(Pose{}, nodes, radius, options);
    double nearest = 1e9;
    for (std::size_t i = 0; i < rail.points.size(); ++i) {
        double d = 1e9;
        for (std::size_t j = 0; j + 1 < nodes.size(); ++j) {
            const Vec3 e = nodes[j + 1] - nodes[j];
            const double t = std::clamp((rail.points[i] - nodes[j]).dot(e) / e.squaredNorm(), 0.0, 1.0);
            d = std::min(d, (rail.points[i] - nodes[j] - t * e).norm());
        }
        EXPECT_LT(d, (options.deviation_limit + 0.1) * 6.0);
        nearest = std::min(nearest, (rail.points[i] - Vec3(0, 0, 60)).norm());
        const Vec3& before = rail.tangent[i > 0 ? i - 1 : 0];
        EXPECT_LT(std::acos(std::min(1.0, rail.tangent[i].dot(before))), 12.0 * units::deg);
    }
    EXPECT_GT(nearest, 0.5);  // the corner itself is cut
    EXPECT_EQ(rail.points.front(), Vec3(0, 0, 0));
    EXPECT_NEAR((rail.points.back() - nodes.back()).norm(), 0.0, 1e-12);
}

TEST(CatheterRail, FramesDoNotTwistInAPlaneAndCloseWithTheSolidAngleOnAHelix) {
    std::vector<Vec3> arch;
    for (int i = 0; i <= 60; ++i)
        arch.emplace_back(40.0 * (1.0 - std::cos(i * units::pi / 60.0)), 0.0, 40.0 * std::sin(i * units::pi / 60.0));
    Pose mouth;  // x axis in the plane of the arch, y square to it
    const Rail rail = build_rail(mouth, arch, {});
    for (std::size_t i = 0; i < rail.points.size(); ++i) EXPECT_NEAR(rail.side[i].y(), 0.0, 1e-9);

    // A helix: against the Frenet frame the side vector turns by minus the torsion integral.
    const double r = 20.0, pitch = 10.0, turns = 2.0;  // pitch per radian
    const double speed = std::sqrt(r * r + pitch * pitch), torsion = pitch / (speed * speed);
    std::vector<Vec3> helix;
    for (int i = 0; i <= 800; ++i) {
        const double t = turns * 2.0 * units::pi * i / 800.0;
        helix.emplace_back(r * std::cos(t), r * std::sin(t), pitch * t);
    }
    mouth.position = helix.front();
    const Rail coil = build_rail(mouth, helix, {});
    const auto angle = [&](std::size_t i) {
        const Vec3 p = coil.points[i];
        const Vec3 inward = Vec3(-p.x(), -p.y(), 0.0).normalized();
        const Vec3 binormal = coil.tangent[i].cross(inward);
        return std::atan2(coil.side[i].dot(binormal), coil.side[i].dot(inward));
    };
    const std::size_t first = 30, last = coil.points.size() - 31;
    double turned = angle(last) - angle(first);
    const double expected = -torsion * (coil.arc[last] - coil.arc[first]);
    turned -= 2.0 * units::pi * std::round((turned - expected) / (2.0 * units::pi));
    EXPECT_NEAR(turned, expected, 0.01);
}

TEST(CatheterRail, AWireThatReachesFartherIsFollowed) {
    std::vector<Vec3> centre, wire;
    for (int i = 0; i <= 50; ++i) {
        centre.emplace_back(0.0, 0.0, 2.0 * i);
        wire.emplace_back(3.0 * std::sin(0.05 * i), 0.0, 2.0 * i);
    }
    const Rail a = build_rail(Pose{}, centre, {}), b = build_rail(Pose{}, wire, {});
    EXPECT_EQ(wire_lead(40.0, 41.0), 0.0);
    EXPECT_EQ(wire_lead(70.0, 41.0), 1.0);
    EXPECT_NEAR(blend(a, b, 1.0).at(60.0).position.x(), b.at(60.0).position.x(), 0.01);
    EXPECT_NEAR(blend(a, b, 0.5).at(60.0).position.x(), 0.5 * b.at(60.0).position.x(), 0.01);
    EXPECT_EQ(blend(a, b, 1.0).points, b.points);
}

TEST(CatheterRail, OverAWireTheShaftStaysWhereItWasLaidAndTheWireLeadsAhead) {
    const auto line = [](double x, double length) {
        std::vector<Vec3> nodes;
        for (double z = 0.0; z <= length; z += 2.0) nodes.emplace_back(x, 0.0, z);
        Pose mouth;
        mouth.position = nodes.front();
        return build_rail(mouth, nodes, {});
    };
    const Rail route = line(0.0, 200.0), wire = line(3.0, 150.0), laid = line(-2.0, 200.0);
    const auto side = [&](double tip, double yielding, double arc) {
        return laid_over_wire(laid, route, wire, tip, yielding).point(arc).x();
    };
    for (const double arc : {10.0, 40.0, 79.0}) {
        EXPECT_NEAR(side(80.0, 0.0, arc), -2.0, 1e-9);
        EXPECT_NEAR(side(80.0, 0.25, arc), -1.5, 1e-9);
        EXPECT_NEAR(side(80.0, 1.0, arc), 0.0, 1e-9);
    }
    EXPECT_NEAR(side(80.0, 0.0, 115.0), 3.0, 0.05);  // along the wire
    EXPECT_NEAR(side(80.0, 0.0, 180.0), 0.0, 0.05);  // beyond its end
    double jump = 0.0;                               // from one to the other in 20 mm, without a corner
    for (double arc = 70.0; arc < 115.0; arc += 0.5)
        jump = std::max(jump, std::fabs(side(80.0, 0.0, arc + 0.5) - side(80.0, 0.0, arc)));
    EXPECT_LT(jump, 0.3);
    EXPECT_EQ(laid_over_wire({}, route, {}, 80.0, 0.0).points, route.points);
    // However often it is laid anew, it stays.
    Rail again = laid;
    for (int k = 0; k < 200; ++k) again = laid_over_wire(again, route, wire, 80.0, 0.0);
    EXPECT_NEAR(again.point(50.0).x(), -2.0, 1e-9);
    EXPECT_NEAR(again.length(), laid_over_wire(laid, route, wire, 80.0, 0.0).length(), 0.5);
}

TEST(CatheterRail, ABlendIsAsLongAsWhereItGoesAndCarriesTheLead) {
    std::vector<Vec3> nodes;
    for (int i = 0; i <= 30; ++i) nodes.emplace_back(3.0, 0.0, 2.0 * i);
    Pose aside;
    aside.position = Vec3(3.0, 0.0, 0.0);
    Rail shorter = build_rail(aside, nodes, {});  // 60 mm long, 3 mm beside the other
    shorter.lead.assign(shorter.points.size(), 0.8);
    nodes.clear();
    for (int i = 0; i <= 50; ++i) nodes.emplace_back(0.0, 0.0, 2.0 * i);
    const Rail longer = build_rail(Pose{}, nodes, {});
    const Rail half = blend(shorter, longer, 0.5);
    EXPECT_NEAR(half.length(), 100.0, 1e-6);
    for (const double arc : {0.0, 30.0, 60.0, 95.0}) {
        EXPECT_NEAR((half.point(arc) - Vec3(1.5, 0.0, arc)).norm(), 0.0, 1e-6) << arc;
        EXPECT_NEAR(half.led(arc), 0.4, 1e-9) << arc;
    }
    EXPECT_NEAR(blend(longer, shorter, 0.25).length(), 60.0, 1e-6);
}
