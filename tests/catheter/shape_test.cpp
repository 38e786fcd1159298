#include "catheter/shape.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/units.h"
#include "straight_rail.h"

using namespace cathlab;

namespace {

CatheterState bent(const CatheterSpec& spec, double insertion, double proximal_deg, double distal_deg,
                   double direction) {
    CatheterState state = initial_state(spec, insertion);
    state.bend_rad = {proximal_deg * units::deg, distal_deg * units::deg};
    state.direction_rad = {direction, direction};
    return state;
}

}  // namespace

TEST(CatheterShape, AnArcIsAPieceOfACircle) {
    Pose start;
    start.position = Vec3(1.0, 2.0, 3.0);
    const double bend = 140.0 * units::deg, direction = 0.7, length = 30.0;
    const Vec3 center = start.position + length / bend * Vec3(std::cos(direction), std::sin(direction), 0.0);
    for (const double part : {0.1, 0.35, 0.8, 1.0}) {
        const Pose p = along_arc(start, part * length, part * bend, direction);
        EXPECT_NEAR((p.position - center).norm(), length / bend, 1e-12);
        const Vec3 z = p.orientation * Vec3::UnitZ();
        EXPECT_NEAR(std::acos(z.z()), part * bend, 1e-12);
        EXPECT_NEAR(z.dot(p.position - center), 0.0, 1e-11);
    }
}

TEST(CatheterShape, AStraightArcIsTheLimitOfABentOne) {
    const Pose straight = along_arc(Pose{}, 30.0, 0.0, 1.0);
    const Pose nearly = along_arc(Pose{}, 30.0, 1e-7, 1.0);
    EXPECT_NEAR((straight.position - Vec3(0, 0, 30)).norm(), 0.0, 1e-15);
    EXPECT_NEAR((straight.position - nearly.position).norm(), 0.0, 3e-6);
}

TEST(CatheterShape, TheTipStandsWhereTheChainOfFramesPutsIt) {
    const CatheterSpec spec;
    const CatheterState state = bent(spec, 200.0, 60.0, 140.0, 0.0);
    const CatheterShape got = shape(spec, state, straight_rail(300.0));
    const double a = 60.0 * units::deg, b = 140.0 * units::deg, base = 200.0 - 63.0;
    // In the plane of the bend, by hand: arc, link, arc, tip.
    Vec2 p(0.0, base);
    const auto arc = [&](double heading, double turn, double length) {
        const double r = length / turn;
        p += r * Vec2(std::cos(heading) - std::cos(heading + turn), std::sin(heading + turn) - std::sin(heading));
    };
    arc(0.0, a, 25.0);
    p += 5.0 * Vec2(std::sin(a), std::cos(a));
    arc(a, b, 30.0);
    p += 3.0 * Vec2(std::sin(a + b), std::cos(a + b));
    EXPECT_NEAR((got.tip.position - Vec3(p.x(), 0.0, p.y())).norm(), 0.0, 1e-9);
    EXPECT_NEAR((got.points.back() - got.tip.position).norm(), 0.0, 1e-9);
    EXPECT_NEAR((got.points.front() - Vec3::Zero()).norm(), 0.0, 1e-12);
}

TEST(CatheterShape, SamplesAreNeverFartherApartThanTheSpacingAndLieAsFarAsTheirArc) {
    const CatheterSpec spec;
    for (const double insertion : {0.0, 0.4, 1.25, 20.0, 63.0, 63.1, 130.3}) {
        const CatheterShape got = shape(spec, bent(spec, insertion, 50.0, 120.0, 1.1), straight_rail(300.0));
        ASSERT_EQ(got.points.size(), got.arc.size());
        ASSERT_FALSE(got.points.empty());
        EXPECT_NEAR(got.arc.back(), insertion, 1e-9);
        for (std::size_t i = 1; i < got.points.size(); ++i) {
            EXPECT_GT(got.arc[i], got.arc[i - 1]);
            EXPECT_LE((got.points[i] - got.points[i - 1]).norm(), catheter_spacing_mm + 1e-9);
        }
    }
}

TEST(CatheterShape, SegmentsComeOutOfTheSheathTipFirstWithoutAJump) {
    const CatheterSpec spec;
    const Rail rail = straight_rail(300.0);
    Vec3 before = shape(spec, bent(spec, 0.0, 60.0, 140.0, 0.3), rail).tip.position;
    for (double insertion = 0.05; insertion < 120.0; insertion += 0.05) {
        const Vec3 now = shape(spec, bent(spec, insertion, 60.0, 140.0, 0.3), rail).tip.position;
        // Rigid swing of the part outside: bend rate along the catheter times its reach bounds the motion.
        EXPECT_LT((now - before).norm(), 0.05 * (1.0 + 140.0 * units::deg / 30.0 * 63.0)) << insertion;
        before = now;
    }
    const CatheterShape short_one = shape(spec, bent(spec, 2.0, 60.0, 140.0, 0.3), rail);
    EXPECT_NEAR((short_one.tip.position - Vec3(0, 0, 2.0)).norm(), 0.0, 1e-12);  // the straight tip alone is out
}

TEST(CatheterShape, TurningTheBaseTurnsTheBend) {
    const CatheterSpec spec;
    const Rail rail = straight_rail(300.0);
    CatheterState turned = bent(spec, 150.0, 30.0, 90.0, 0.0);
    turned.rotation_rad = 0.9;
    const Vec3 a = shape(spec, turned, rail).tip.position;
    const Vec3 b = shape(spec, bent(spec, 150.0, 30.0, 90.0, 0.9), rail).tip.position;
    EXPECT_NEAR((a - b).norm(), 0.0, 1e-9);
}

TEST(CatheterSpec, NumbersOutOfRangeAreNamed) {
    CatheterSpec spec;
    EXPECT_NO_THROW(validate(spec));
    spec.segments[1].max_bend_deg = 400.0;
    try {
        validate(spec, {"x.toml", 3, ""});
        FAIL();
    } catch (const UserError& error) {
        EXPECT_NE(std::string(error.what()).find("max_bend_deg"), std::string::npos) << error.what();
        EXPECT_NE(std::string(error.what()).find("180"), std::string::npos) << error.what();
    }
    spec = {};
    spec.outer_diameter_mm = std::nan("");
    EXPECT_THROW(validate(spec), UserError);
    spec = {};
    spec.segments.clear();
    EXPECT_THROW(validate(spec), UserError);
}

namespace {

Rail round_rail(double radius) {
    std::vector<Vec3> nodes;
    for (double s = 0.0; s <= 300.0; s += 1.0)
        nodes.emplace_back(radius - radius * std::cos(s / radius), 0.0, radius * std::sin(s / radius));
    return build_rail(Pose{}, nodes, {});
}

// Angle between base and tip, radians.
double turned(const CatheterShape& s) {
    const Vec3 from = s.base.orientation * Vec3::UnitZ(), to = s.tip.orientation * Vec3::UnitZ();
    return std::atan2(from.cross(to).norm(), from.dot(to));
}

}  // namespace

TEST(CatheterShape, AWireInsideAndTheBendsShareTheCurvatureByTheirStiffnesses) {
    const CatheterSpec spec;
    const double radius = 100.0, steerable = spec.steerable_length_mm();
    Rail rail = round_rail(radius);
    const CatheterState straight = initial_state(spec, 200.0);
    EXPECT_NEAR(turned(shape(spec, straight, rail)), 0.0, 1e-9);  // no wire: straight on
    for (const double share : {0.25, 0.9, 1.0}) {
        rail.lead.assign(rail.points.size(), share);
        EXPECT_NEAR(turned(shape(spec, straight, rail)), share * steerable / radius, 0.01 * steerable / radius);
        // Bent against the rail: what is left of its own bend comes off.
        const CatheterState back = bent(spec, 200.0, 10.0, 20.0, units::pi);
        const double own = 30.0 * units::deg;
        EXPECT_NEAR(turned(shape(spec, back, rail)), std::fabs(share * steerable / radius - (1.0 - share) * own), 0.01);
    }
    // A rail that leads it wholly carries the tip along its own curve.
    const CatheterShape led = shape(spec, straight, rail);
    EXPECT_LT((led.tip.position - rail.point(200.0)).norm(), 0.05);
}

TEST(CatheterShape, AWireThatReachesHalfWayLeadsThatHalf) {
    const CatheterSpec spec;
    const double radius = 100.0, steerable = spec.steerable_length_mm(), base = 200.0 - steerable;
    Rail rail = round_rail(radius);
    for (const double arc : rail.arc) rail.lead.push_back(arc < base + 0.5 * steerable ? 1.0 : 0.0);
    EXPECT_NEAR(turned(shape(spec, initial_state(spec, 200.0), rail)), 0.5 * steerable / radius,
                0.01 * steerable / radius);
}
