// A wire beside a catheter lies on its outside and does not pass through.
#include <gtest/gtest.h>

#include <cmath>

#include "contact/inside_catheter.h"
#include "rod/rod_fixture.h"

namespace cathlab {
namespace {

struct Beside {
    std::vector<Vec3> points;
    std::vector<double> arc;
    CatheterOutside outside(double radius) const { return {{points, arc}, radius, 2e-4, 1.5, 0.1, 0.0, 0.0, {}}; }
};

/// A catheter across the wire's way, `height` above the sheath, whose axis passes the wire's at x = offset.
Beside across(double height, double offset) {
    Beside b;
    for (int i = 0; i <= 40; ++i) {
        b.points.push_back(Vec3(offset, 2.0 * i - 40.0, height));
        b.arc.push_back(2.0 * i);
    }
    return b;
}

/// A substep under forces on the links, fed in by advance; the force (mN, along x) with which the catheter is pressed.
double solve(Rod& rod, const CatheterOutside& catheter, double h, std::span<const Vec3> force, double advance = 0.0) {
    rod.command(advance, 0.0);
    std::vector<RodSample> before;
    rod.samples(1.25, before);
    rod.predict(h, force);
    double pressed = 0.0;
    for (int k = 0; k < 3; ++k) {
        std::vector<RodSample> samples;
        rod.samples(1.25, samples);
        std::vector<SampleMotion> motion(samples.size());
        for (std::size_t i = 0; i < samples.size(); ++i) motion[i].way = samples[i].position - before[i].position;
        std::vector<std::size_t> all(samples.size());
        for (std::size_t i = 0; i < all.size(); ++i) all[i] = i;
        std::vector<ChainRow> rows;
        add_outside_rows(catheter, samples, motion, all, rows);
        rod.solve(h, rows);
        pressed = 0.0;
        for (const ChainRow& row : rows) pressed += row.multiplier * row.normal.x();
    }
    rod.finish(h);
    return pressed;
}

TEST(OutsideCatheter, AWirePressedAgainstItsSideStaysOutsideAndFeelsTheForce) {
    // A cantilever of length L pressed at its tip by F against a rest at a: the rest carries F (3 L - a) / 2 a less
    // what its own deflection d there takes, 3 EI d / a^3.
    const double length = 101.0, height = 60.0, radius = 1.0, force = 20.0;
    Rod rod(test::bmw(2.0), {}, length);
    const Beside catheter = across(height, 2.0);
    std::vector<Vec3> push{Vec3(force, 0.0, 0.0)};
    double pressed = 0.0;
    for (int i = 0; i < 400; ++i) pressed = solve(rod, catheter.outside(radius), 0.05, push);
    double nearest = 1e9, x = 0.0;
    for (const Vec3& p : rod.polyline()) {
        const double d = std::hypot(p.x() - 2.0, p.z() - height);
        if (d < nearest) {
            nearest = d;
            x = p.x();
        }
    }
    const double touching = radius + 0.178;
    EXPECT_GT(nearest, touching - 0.05);
    EXPECT_LT(x, 2.0);
    const double ei = 75e3, d = 2.0 - touching;
    const double expected = force * (3.0 * length - height) / (2.0 * height) - 3.0 * ei * d / std::pow(height, 3);
    EXPECT_NEAR(-pressed, expected, 0.05 * expected);
}

TEST(OutsideCatheter, AWireThatSlidesAlongItIsHeldBackByTheCoefficientTimesTheLoad) {
    // Pressed against it and fed in, then drawn back at the same speed: half the difference of what the sheath reads is
    // the friction, whatever the wire's own bend adds to either.
    const double friction = 0.3, h = 0.02, advance = 0.04;
    Rod rod(test::bmw(2.0), {}, 101.0);
    const Beside line = across(60.0, 2.0);
    CatheterOutside catheter = line.outside(1.0);
    catheter.friction = friction;
    const std::vector<Vec3> push{Vec3(20.0, 0.0, 0.0)};
    for (int i = 0; i < 400; ++i) solve(rod, catheter, 0.05, push);
    const auto slide = [&](double way, double& pressed) {
        double sheath = 0.0;
        for (int i = 0; i < 100; ++i) {
            pressed = solve(rod, catheter, h, push, way);
            sheath = rod.sheath_force_mn();
        }
        return sheath;
    };
    double in_load = 0.0, out_load = 0.0;
    const double in = slide(advance, in_load), out = slide(-advance, out_load);
    const double load = 0.5 * std::fabs(in_load + out_load);
    EXPECT_GT(load, 10.0);
    EXPECT_NEAR(0.5 * (in - out), friction * load, 0.05 * friction * load);
}

TEST(OutsideCatheter, ACatheterThatMovesAlongTakesTheWireWithItByFriction) {
    // A wire at rest beside a catheter that is fed past it: the slip is the catheter's motion turned round.
    std::vector<Vec3> before, now;
    std::vector<double> arc;
    for (int i = 0; i <= 10; ++i) {
        before.push_back(Vec3(0.0, 0.0, 2.0 * i));
        now.push_back(Vec3(0.0, 0.0, 2.0 * i + 0.25));
        arc.push_back(2.0 * i);
    }
    const CatheterOutside catheter{{now, arc}, 1.0, 2e-4, 1.5, 0.1, 0.0, 0.2, before};
    const std::vector<RodSample> samples{{0, Vec3::Zero(), Vec3(1.1, 0.0, 10.0), 0.2}};
    std::vector<SampleMotion> motion(1);
    const std::vector<std::size_t> all{0};
    std::vector<ChainRow> rows;
    add_outside_rows(catheter, samples, motion, all, rows);
    ASSERT_EQ(rows.size(), 1U);
    EXPECT_EQ(rows[0].friction, 0.2);
    EXPECT_NEAR((rows[0].slip - Vec3(0.0, 0.0, -0.25)).norm(), 0.0, 1e-12);
    // Moving along with it, and turning about an axis along it by 0.1 rad: the surface goes back by radius x angle.
    motion[0] = {Vec3(0.0, 0.0, 0.25), Vec3(0.0, 0.0, 0.1)};
    rows.clear();
    add_outside_rows(catheter, samples, motion, all, rows);
    EXPECT_NEAR((rows[0].slip - Vec3(0.0, -0.02, 0.0)).norm(), 0.0, 1e-12);
}

TEST(OutsideCatheter, ItsTipIsRoundAndNothingTouchesNearItsSheath) {
    Beside b;
    for (int i = 0; i <= 10; ++i) {
        b.points.push_back(Vec3(0.0, 0.0, 2.0 * i));
        b.arc.push_back(2.0 * i);
    }
    CatheterOutside catheter = b.outside(1.0);
    catheter.near_mouth_mm = 4.0;
    const auto rows_at = [&](const Vec3& p) {
        const std::vector<RodSample> samples{{0, Vec3::Zero(), p, 0.2}};
        const std::vector<std::size_t> all{0};
        std::vector<ChainRow> rows;
        add_outside_rows(catheter, samples, std::vector<SampleMotion>(1), all, rows);
        return rows;
    };
    EXPECT_NEAR(rows_at(Vec3(0.0, 0.0, 21.5)).at(0).gap, 0.3, 1e-12);  // before the tip
    EXPECT_TRUE(rows_at(Vec3(0.5, 0.0, 1.0)).empty());                 // in the sheath's mouth
    EXPECT_TRUE(rows_at(Vec3(0.5, 0.0, 3.0)).empty());
    EXPECT_TRUE(rows_at(Vec3(4.0, 0.0, 10.0)).empty());  // far
    const std::vector<ChainRow> rows = rows_at(Vec3(1.5, 0.0, 10.0));
    ASSERT_EQ(rows.size(), 1U);
    EXPECT_NEAR(rows[0].gap, 0.3, 1e-12);
    EXPECT_NEAR((rows[0].normal - Vec3::UnitX()).norm(), 0.0, 1e-12);
    EXPECT_NEAR(rows_at(Vec3(0.0, 0.0, 10.0)).at(0).gap, -0.1, 1e-12);  // on its axis: pushed out gently
}

}  // namespace
}  // namespace cathlab
