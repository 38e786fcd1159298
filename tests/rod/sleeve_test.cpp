// A passive catheter over the wire: what adds, what slides, what turns, what rubs.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "core/errors.h"
#include "core/hash.h"
#include "core/units.h"
#include "rigid_guide.h"
#include "rod/sleeve_spec.h"
#include "sectioned_beam.h"

namespace cathlab {
namespace {

using test::GuidedWire;
using test::Touch;

SleeveSpec tube(double ei = 200.0, double length = 500.0) {
    SleeveSpec spec;
    spec.name = "tube";
    spec.length_mm = length;
    spec.link_length_mm = 4.0;
    spec.inner_diameter_mm = 1.0;
    WireSection section;
    section.length_mm = length;
    section.diameter_mm = 1.67;
    section.bending_stiffness_n_mm2 = ei;
    section.torsion_stiffness_n_mm2 = ei / 1.4;
    section.axial_stiffness_n = 800.0;
    section.density_kg_m3 = 1000.0;
    section.material = "polymer";
    spec.sections = {section};
    return spec;
}

WireSpec wire() {  // with a soft tip of 60 mm
    WireSpec spec = test::uniform_wire(150.0, 0.889, 4.0, 700.0);
    WireSection tip = spec.sections[0];
    tip.length_mm = 60.0;
    tip.bending_stiffness_n_mm2 = 30.0;
    tip.torsion_stiffness_n_mm2 = 25.0;
    tip.link_length_mm = 2.5;
    spec.sections.insert(spec.sections.begin(), tip);
    return spec;
}

/// Sum of compliance x f from `begin` to the wire's insertion when the catheter's tip is `ahead` behind the wire's.
double over_both(const WireSpec& w, const SleeveSpec& s, double begin, double insertion, double ahead,
                 double WireSection::*stiffness, const std::function<double(double)>& f) {
    const WireSpec outer = as_wire(s);
    const int n = 20000;
    const double ds = (insertion - begin) / n;
    double sum = 0.0;
    for (int i = 0; i < n; ++i) {
        const double at = begin + (i + 0.5) * ds;
        double k = at < 0.0 ? 0.0 : test::section_at(w, at).*stiffness;
        if (at >= ahead) k += test::section_at(outer, at - ahead).*stiffness;
        sum += f(at) * ds / (1000.0 * k);
    }
    return sum;
}

TEST(Sleeve, WhereTheyOverlapBendingStiffnessesAdd) {
    const WireSpec w = wire();
    const SleeveSpec s = tube();
    for (const auto& [wire_out, tube_out] :
         std::vector<std::pair<double, double>>{{200, 120}, {200, 190}, {130, 200}}) {
        Rod rod(w, s, {}, wire_out, tube_out);
        const double ahead = wire_out - tube_out, out = std::max(wire_out, tube_out);
        const double chain_to_wire = ahead > 0.0 ? 0.0 : ahead;  // arcs below are the wire's
        const double begin = 0.5 * rod.link_length(0) + chain_to_wire, insertion = wire_out;
        const double per_mn = over_both(w, s, begin, insertion, ahead, &WireSection::bending_stiffness_n_mm2,
                                        [&](double at) { return (at - begin) * (at - begin); });
        const double expected = 0.01 * out;
        test::settle(rod, 0, Vec3(expected / per_mn, 0.0, 0.0), 0.5, 80);
        const double drop = rod.link_pose(0).position.x();
        std::printf("wire %.0f, tube %.0f out: drops %.4f of %.4f mm\n", wire_out, tube_out, drop, expected);
        EXPECT_NEAR(drop, expected, 0.01 * expected);
    }
}

TEST(Sleeve, WhereTheyOverlapAxialAndTorsionalStiffnessesAdd) {
    const WireSpec w = wire();
    const SleeveSpec s = tube();
    const double wire_out = 200.0, tube_out = 130.0, ahead = wire_out - tube_out;
    const auto one = [](double) { return 1.0; };
    Rod rod(w, s, {}, wire_out, tube_out);
    const double begin = 0.5 * rod.link_length(0), before = rod.link_pose(0).position.z();
    test::settle(rod, 0, Vec3(0.0, 0.0, 1000.0), 0.5, 80);
    const double longer = 1000.0 * over_both(w, s, begin, wire_out, ahead, &WireSection::axial_stiffness_n, one);
    EXPECT_NEAR(rod.link_pose(0).position.z() - before, longer, 0.01 * longer);

    // Both grips turned while the tip is held: torque = angle / sum of ds / GJ.
    GuidedWire held(Rod(w, s, {}, wire_out, tube_out));
    held.compliance = 1e-9;
    held.walls = [&](const RodSample& sample, std::vector<Touch>& out) {
        if (sample.link != 0) return;
        const Pose tip = held.rod.link_pose(0);
        for (const double side : {1.0, -1.0}) {
            const Vec3 offset = tip.orientation * Vec3(side, 0.0, 0.0);
            out.push_back({Vec3::UnitY(), tip.position.y() + offset.y(), offset, true});
        }
    };
    for (int i = 0; i < 50; ++i) {
        held.rod.command_sleeve(0.0, 0.004);
        held.step(0.1, 0.0, 0.004);
    }
    for (int i = 0; i < 50; ++i) held.step(0.1);
    const double torque = 0.2 / over_both(w, s, begin, wire_out, ahead, &WireSection::torsion_stiffness_n_mm2, one);
    EXPECT_NEAR(held.rod.sheath_torque_mn_mm(), torque, 0.01 * torque);
}

TEST(Sleeve, EitherMovesAloneAndTheOtherStays) {
    Rod rod(wire(), tube(), {}, 150.0, 100.0);
    const auto run = [&](double wire_speed, double tube_speed, double seconds) {
        const double h = 0.005;
        for (int i = 0; i < seconds / h; ++i) {
            rod.command_sleeve(tube_speed * h, 0.0);
            test::substep(rod, h, {}, {}, wire_speed * h);
        }
        for (int i = 0; i < 40; ++i) test::substep(rod, 0.1);
    };
    const auto expect = [&](double wire_tip, double tube_tip) {
        EXPECT_NEAR(rod.insertion_mm(), wire_tip, 1e-9);
        EXPECT_NEAR(rod.sleeve_insertion_mm(), tube_tip, 1e-9);
        EXPECT_NEAR(rod.tip().z(), wire_tip, 1e-3);
        EXPECT_NEAR(rod.sleeve_tip().z(), tube_tip, 1e-3);
    };
    run(100.0, 0.0, 0.5);
    expect(200.0, 100.0);
    run(0.0, 80.0, 0.5);
    expect(200.0, 140.0);
    run(-60.0, 100.0, 1.0);  // past each other: the catheter leads
    expect(140.0, 240.0);
    EXPECT_EQ(rod.front_count(), 0U);
    run(100.0, 0.0, 1.5);  // and out again
    expect(290.0, 240.0);
    EXPECT_GT(rod.front_count(), 10U);
    run(0.0, -100.0, 2.4);  // the catheter wholly withdrawn
    expect(290.0, 0.0);
    run(-100.0, 50.0, 3.0);  // the wire wholly withdrawn: the catheter alone
    expect(0.0, 150.0);
}

TEST(Sleeve, TheWireMovingInsideDoesNotMoveTheCatheter) {
    // Round a bend: in the overlap nothing slides but the wire inside.
    Rod rod(wire(), tube(), {}, 150.0, 100.0);
    const std::vector<Vec3> load{Vec3(8.0, 0.0, 0.0)};
    test::settle(rod, 0, load[0], 0.2, 200);
    const auto behind = [&](double from_mouth) {
        double best = 1e9;
        Vec3 at = Vec3::Zero();
        for (std::size_t i = rod.front_count(); i < rod.free_link_count(); ++i)
            if (std::fabs(rod.link_pose(i).position.z() - from_mouth) < best) {
                best = std::fabs(rod.link_pose(i).position.z() - from_mouth);
                at = rod.link_pose(i).position;
            }
        return at;
    };
    const Vec3 before = behind(50.0), tip = rod.sleeve_tip();
    for (int i = 0; i < 100; ++i) test::substep(rod, 0.005, {}, {}, 0.2);
    const Vec3 after = behind(50.0);
    EXPECT_NEAR(after.z(), before.z(), 0.5);
    EXPECT_NEAR(rod.sleeve_tip().z(), tip.z(), 5.0);  // it straightens as the load is gone
    EXPECT_NEAR((rod.tip() - rod.sleeve_tip()).norm(), 70.0, 0.5);
}

TEST(Sleeve, PassingEachOtherMakesNoJump) {
    // A bent pair; the wire is drawn back into the catheter and comes out again, slowly.  Nothing jumps.
    Rod rod(wire(), tube(), {}, 140.0, 100.0);
    std::vector<Vec3> load{Vec3(4.0, 0.0, 0.0)};
    test::settle(rod, 0, load[0], 0.2, 300);
    Vec3 last = rod.sleeve_tip(), last_step = Vec3::Zero();
    double energy = rod.energy_uj(), worst = 0.0, most_energy = energy;
    std::size_t changes = 0, front = rod.front_count();
    for (int i = 0; i < 1600; ++i) {
        // The load stays on the catheter's tip.
        rod.command(i < 800 ? -0.1 : 0.1, 0.0);
        load.assign(rod.front_count() + 1, Vec3::Zero());
        load.back() = Vec3(4.0, 0.0, 0.0);
        rod.predict(0.02, load);
        rod.solve(0.02, {});
        rod.solve(0.02, {});
        rod.finish(0.02);
        const Vec3 step = rod.sleeve_tip() - last;
        if (i > 40 && std::abs(i - 820) > 40) worst = std::max(worst, (step - last_step).norm());
        most_energy = std::max(most_energy, rod.energy_uj());
        changes += rod.front_count() != front;
        front = rod.front_count();
        last_step = step;
        last = rod.sleeve_tip();
    }
    std::printf("passing: %zu links made or unmade, largest change of a step of 0.1 mm: %.4f mm; energy %.1f to %.1f\n",
                changes, worst, energy, most_energy);
    EXPECT_GT(changes, 20U);
    EXPECT_LT(worst, 0.003);
    EXPECT_LT(most_energy, 1.1 * energy);
    EXPECT_LT(rod.max_stretch(), 1e-3);
}

TEST(Sleeve, EachTurnsByItsOwnGrip) {
    SleeveSpec s = tube();
    s.wire_friction = 0.0;
    Rod rod(wire(), s, {}, 150.0, 100.0);
    const auto angle_of = [&](std::size_t link) {
        const Vec3 x = rod.link_pose(link).orientation * Vec3::UnitX();
        return std::atan2(x.y(), x.x());
    };
    for (int i = 0; i < 100; ++i) test::substep(rod, 0.01, {}, {}, 0.0, 0.02);
    for (int i = 0; i < 50; ++i) test::substep(rod, 0.1);
    EXPECT_NEAR(angle_of(0), 2.0, 1e-3);
    EXPECT_NEAR(angle_of(rod.front_count()), 0.0, 1e-3);
    for (int i = 0; i < 100; ++i) {
        rod.command_sleeve(0.0, -0.01);
        test::substep(rod, 0.01);
    }
    for (int i = 0; i < 50; ++i) test::substep(rod, 0.1);
    EXPECT_NEAR(angle_of(0), 2.0, 1e-3);
    EXPECT_NEAR(angle_of(rod.front_count()), -1.0, 1e-3);
}

TEST(Sleeve, AShapedTipOfTheWireIsStraightenedByAStifferCatheterAndComesBack) {
    WireSpec w = wire();
    WireSection tip = w.sections[0];
    tip.length_mm = 15.0;
    tip.rest_curvature_per_mm = 0.05;
    w.sections.insert(w.sections.begin(), tip);
    const SleeveSpec s = tube(600.0);
    Rod rod(w, s, {}, 100.0, 130.0);
    for (int i = 0; i < 200; ++i) test::substep(rod, 0.1);
    // Inside it bends both by EI_w kappa / (EI_w + EI_c) over its 15 mm.
    const Vec3 axis = rod.link_pose(0).orientation * Vec3::UnitZ();
    const double both = 0.05 * 15.0 * 30.0 / 630.0;
    EXPECT_NEAR(std::fabs(std::atan2(axis.y(), axis.z())), both, 0.02 * both);
    for (int i = 0; i < 500; ++i) test::substep(rod, 0.01, {}, {}, 0.1);
    for (int i = 0; i < 200; ++i) test::substep(rod, 0.1);
    const Vec3 out = rod.link_pose(0).orientation * Vec3::UnitZ();
    EXPECT_NEAR(std::fabs(std::atan2(out.y(), out.z())), 0.05 * (15.0 - 0.5 * rod.link_length(0)), 0.02);
}

TEST(Sleeve, TheyPressOnEachOtherByTheWiresShareOfTheLoad) {
    // On two supports and pressed between them: of each force the wire's share EI_w / (EI_w + EI_c) goes through the
    // bore.
    const WireSpec w = test::uniform_wire(150.0, 0.889, 4.0, 700.0);
    const SleeveSpec s = tube();
    GuidedWire pair(Rod(w, s, {}, 230.0, 220.0));
    const auto nearest = [&](double z) {
        std::size_t best = 0;
        for (std::size_t i = 1; i < pair.rod.free_link_count(); ++i)
            if (std::fabs(pair.rod.link_pose(i).position.z() - z) <
                std::fabs(pair.rod.link_pose(best).position.z() - z))
                best = i;
        return best;
    };
    const std::size_t first = nearest(80.0), second = nearest(180.0), pressed = nearest(130.0);
    pair.compliance = 1e-7;
    pair.walls = [&](const RodSample& sample, std::vector<Touch>& out) {
        const auto link = static_cast<std::size_t>(sample.link);
        if (link == first || link == second) out.push_back({Vec3::UnitX(), sample.position.x()});
    };
    std::vector<Vec3> load(pressed + 1, Vec3::Zero());
    load[pressed] = Vec3(-50.0, 0.0, 0.0);
    for (int i = 0; i < 200; ++i) pair.step(0.3, 0.0, 0.0, load);
    double forces = 50.0;
    for (const ChainRow& row : pair.rows) forces += row.multiplier;
    const double expected = forces * 150.0 / 350.0;
    std::printf("between wire and catheter: %.3f mN of %.3f\n", pair.rod.sleeve_load_mn(), expected);
    EXPECT_NEAR(pair.rod.sleeve_load_mn(), expected, 0.05 * expected);

    // The wire's hand needs that much times the coefficient to slide it, the catheter's hand holds against it.
    pair.step(0.005, 0.05, 0.0, load);
    pair.step(0.005, 0.05, 0.0, load);
    EXPECT_NEAR(pair.rod.sheath_force_mn(), s.wire_friction * expected, 0.1 * s.wire_friction * expected + 0.5);
    EXPECT_NEAR(pair.rod.sheath_force_mn() + pair.rod.sleeve_force_mn(), pair.rod.sheath_reaction_mn().z(), 1e-9);
}

TEST(Sleeve, FrictionInTheBoreLetsTheTipLagBehindTheGrip) {
    const WireSpec w = test::uniform_wire(150.0, 0.889, 4.0, 700.0);
    SleeveSpec s = tube();
    s.wire_friction = 0.5;
    Rod rod(w, s, {}, 230.0, 200.0);
    test::settle(rod, rod.front_count(), Vec3(15.0, 0.0, 0.0), 0.2, 200);
    std::vector<Vec3> load(rod.front_count() + 1, Vec3::Zero());
    load.back() = Vec3(15.0, 0.0, 0.0);
    const double play = rod.sleeve_play_rad();
    EXPECT_GT(play, 1e-3);
    const auto turned = [&] {
        const Quat d = rod.link_pose(rod.front_count()).orientation.conjugate() * rod.link_pose(0).orientation;
        return 2.0 * std::atan2(d.z(), d.w());
    };
    const double before = turned();
    for (int i = 0; i < 100; ++i) test::substep(rod, 0.02, load, {}, 0.0, 0.01);
    for (int i = 0; i < 50; ++i) test::substep(rod, 0.1, load);
    std::printf("play %.4f rad, the tip is %.4f behind\n", play, 1.0 - (turned() - before));
    EXPECT_NEAR(1.0 - (turned() - before), rod.sleeve_play_rad(), 0.01);
}

TEST(Sleeve, BadNumbersAreNamed) {
    const auto complains_of = [](const char* key, const auto& spoil) {
        SleeveSpec s = tube();
        spoil(s);
        try {
            const Rod rod(wire(), s, {}, 60.0, 40.0);
        } catch (const UserError& error) {
            return std::string(error.what()).find(key) != std::string::npos;
        }
        return false;
    };
    EXPECT_TRUE(complains_of("inner_diameter_mm", [](SleeveSpec& s) { s.inner_diameter_mm = 1.8; }));
    EXPECT_TRUE(complains_of("does not go through", [](SleeveSpec& s) { s.inner_diameter_mm = 0.5; }));
    EXPECT_TRUE(complains_of("wire_friction", [](SleeveSpec& s) { s.wire_friction = std::nan(""); }));
    EXPECT_TRUE(complains_of("bending_stiffness", [](SleeveSpec& s) { s.sections[0].bending_stiffness_n_mm2 = 0.0; }));
    EXPECT_TRUE(complains_of("length_mm", [](SleeveSpec& s) { s.length_mm = -1.0; }));
    EXPECT_TRUE(complains_of("sections", [](SleeveSpec& s) { s.sections.clear(); }));
}

TEST(Sleeve, NonsenseOnBothGripsIsClampedAndStaysFinite) {
    Rod rod(wire(), tube(), {}, 60.0, 40.0);
    const double nan = std::nan("");
    EXPECT_EQ(rod.command_sleeve(nan, nan), 0.0);
    EXPECT_LE(rod.command_sleeve(1e9, -1e9), Rod::max_travel_mm());
    for (int i = 0; i < 2000; ++i) {
        const double a = i % 700 < 350 ? 1e6 : -1e6, b = i % 500 < 230 ? -1e6 : 1e6;
        rod.command_sleeve(a, b);
        test::substep(rod, 0.005, {}, {}, b, a);
        ASSERT_TRUE(std::isfinite(rod.tip().squaredNorm() + rod.energy_uj())) << i;
    }
}

TEST(Sleeve, TheSameHistoryGivesTheSameBits) {
    const auto history = [](double turn) {
        Rod rod(wire(), tube(), {}, 90.0, 60.0);
        HashArchive hash;
        for (int i = 0; i < 200; ++i) {
            rod.command_sleeve(0.3, turn);
            test::substep(rod, 0.005, std::vector{Vec3(5.0, 1.0, 0.0)}, {}, 0.1, 0.01);
            visit(hash, rod);
        }
        return hash.value();
    };
    EXPECT_EQ(history(0.01), history(0.01));
    EXPECT_NE(history(0.01), history(0.010001));
}

}  // namespace
}  // namespace cathlab
