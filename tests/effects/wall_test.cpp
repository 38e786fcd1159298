// Effects of the wall, each against the closed form of its law at one point of the membrane.
#include <gtest/gtest.h>

#include <cmath>

#include "effects/effect.h"
#include "effects/measure.h"
#include "effects/without_strength.h"
#include "softbody/uniaxial.h"

namespace cathlab {
namespace {

const MembraneMaterial rubber{100.0, 0.49 / 0.51, Vec2(1.0, 0.0)};

/// One point of the wall with one effect.
class Point {
public:
    Point(const char* name, std::vector<double> values) : effect_(find_effect(name)->make(values)) {
        effect_->points(1);
    }
    /// What the law says at a stretch, dt after what was asked before; it remembers.
    MembranePoint at(double along, double across, double dt = 0.0) {
        MembranePoint point = ask(along, across, dt);
        effect_->remember(context_, point);
        return point;
    }
    MembranePoint ask(double along, double across, double dt = 0.0) {
        context_.dt = dt;
        MembranePoint point;
        point.c = Vec3(along * along, across * across, 0.0);
        Effect* const effects[1] = {effect_.get()};
        ask_membrane(effects, context_, rubber, {}, point);
        return point;
    }

private:
    std::unique_ptr<Effect> effect_;
    EffectContext context_;
};

MembranePoint elastic(double along, double across) {
    MembranePoint point;
    point.c = Vec3(along * along, across * across, 0.0);
    ask_elastic_law(rubber, {}, point);
    return point;
}

TEST(Wall, AnEffectWhoseStrengthsAreAllZeroChangesNothing) {
    effects_test::for_each_without_strength(hook_membrane, [](const EffectInfo& info, const auto& values) {
        Point point(info.name.data(), values);
        for (const double stretch : {1.0, 1.3, 1.1, 0.8, 1.4}) {
            const MembranePoint found = point.at(stretch, 0.9, 0.1), wanted = elastic(stretch, 0.9);
            EXPECT_EQ(found.stress, wanted.stress) << info.name;
            EXPECT_EQ(found.at_once, 1.0) << info.name;
        }
    });
}

TEST(Wall, TheUniaxialClosedFormOfTheElasticLawIsThatOfANeoHookeanSolid) {
    for (const double stress : {-200.0, -20.0, 5.0, 60.0, 300.0}) {
        Uniaxial at;
        ASSERT_TRUE(uniaxial_rest([](MembranePoint& p) { ask_elastic_law(rubber, {}, p); }, 298.0, stress, at));
        EXPECT_NEAR(at.across, std::pow(at.along, -0.49), 1e-6);
        EXPECT_NEAR(100.0 * (at.along - std::pow(at.along, -1.98)), stress, 1e-4 * (298.0 + std::fabs(stress)));
    }
}

TEST(Wall, HookesLawIsAStraightLineInStretches) {
    MembraneMaterial hooke = rubber;
    hooke.hooke = 1.0;
    for (const double stress : {-60.0, 30.0, 120.0}) {
        Uniaxial at;
        ASSERT_TRUE(uniaxial_rest([&](MembranePoint& p) { ask_elastic_law(hooke, {}, p); }, 298.0, stress, at));
        EXPECT_NEAR(at.along - 1.0, stress / 298.0, 1e-6);
        EXPECT_NEAR(at.across - 1.0, -0.49 * stress / 298.0, 1e-6);
    }
}

TEST(Wall, ASlackWallBearsNothingUntilItIsStraight) {
    Point point("slack", {0.1, 0.001});
    EXPECT_NEAR(point.at(std::sqrt(1.19), 1.0).stress[0], 0.0, 0.1);
    const double c = 1.5, taken = c - 2.0 * 0.1;  // the other stretch is shorter than at rest: no slack there
    const MembranePoint found = point.at(std::sqrt(c), 0.9);
    EXPECT_NEAR(found.stress[0], elastic(std::sqrt(taken), 0.9).stress[0], 0.1);
    Point firm("slack", {0.1, 0.2});
    EXPECT_NEAR(firm.at(std::sqrt(1.1), 0.9).stress[0], elastic(std::sqrt(1.0 + 0.2 * 0.1), 0.9).stress[0], 1e-9);
    // Pressed, it is as it was.
    EXPECT_NEAR(point.at(0.9, 0.9).stress[0], elastic(0.9, 0.9).stress[0], 1e-9);
}

TEST(Wall, FoldsOfAWallWithAMemoryCloseWithTheTensionAndNotWithTheStrain) {
    const auto slack = find_effect("slack")->make(std::vector<double>{0.02, 0.06});
    const auto memory = find_effect("viscoelasticity")->make(std::vector<double>{0.25, 2.0, 1.0});
    Effect* const effects[2] = {slack.get(), memory.get()};
    for (Effect* effect : effects) effect->points(1);
    EffectContext context;
    Uniaxial at;
    double strain = 0.0;  // Green's, of the wall between its folds
    const auto folds = [&](double stress) {
        EXPECT_TRUE(
            uniaxial_rest([&](MembranePoint& p) { ask_membrane(effects, context, rubber, {}, p); }, 298.0, stress, at));
        MembranePoint point;
        point.c = Vec3(at.along * at.along, at.across * at.across, 0.0);
        const double whole = 0.5 * (point.c[0] - 1.0);
        ask_membrane(effects, context, rubber, {}, point);
        for (Effect* effect : effects) effect->remember(context, point);
        context.dt = 0.25;
        strain = 0.5 * (point.c[0] - 1.0);
        return whole - strain;
    };
    const double full = 0.94 * 0.02;
    for (const double stress : {0.0, 5.0, 15.0, 15.0, 15.0, 5.0}) {
        const double taken = folds(stress);
        EXPECT_NEAR(taken, stress > 0.0 ? full : 0.0, 1e-9) << stress;
    }
    // They are straight from the stress on that the wall bears at `remnant` of the slack.
    const double straight = 298.0 * 0.06 * 0.02, taken = folds(0.3 * straight);
    EXPECT_NEAR(taken, 0.3 * full, 0.02 * full);
    EXPECT_GT(strain, 0.004) << "what is left of the strain goes slowly";
}

TEST(Wall, CreepGoesWithTheLogarithmOfTimeAndStays) {
    Point point("creep", {0.05, 2.0, 2.0});
    // The elastic part is held: what is asked for grows by what has flowed.
    double flowed = 0.0;
    const double elastic_strain = 0.1;
    for (int k = 0; k < 400; ++k) {
        const double stretch = std::sqrt(1.0 + 2.0 * (elastic_strain + flowed));
        point.at(stretch, 1.0, 0.05);
        const MembranePoint now = point.ask(stretch, 1.0);
        flowed += elastic_strain - 0.5 * (now.c[0] - 1.0);
    }
    EXPECT_NEAR(flowed, 0.05 * elastic_strain * std::log(1.0 + 20.0 / 2.0), 1e-6);
    const MembranePoint back = point.ask(std::sqrt(1.0 + 2.0 * flowed), 1.0);
    EXPECT_NEAR(back.stress[0], 0.0, 1e-3);
}

TEST(Wall, AWallThatWasStretchedFurtherIsSofterByOgdenAndRoxburghsFactor) {
    Point point("softening", {0.4, 0.5});
    EXPECT_EQ(point.at(1.2, 0.95).stress, elastic(1.2, 0.95).stress);
    const MembranePoint top = point.at(1.4, 0.9);
    EXPECT_EQ(top.stress, elastic(1.4, 0.9).stress);
    const MembranePoint found = point.at(1.2, 0.95), law = elastic(1.2, 0.95);
    const double eta = 1.0 - 0.4 * std::erf((top.energy_kpa - law.energy_kpa) / (0.5 * top.energy_kpa));
    EXPECT_NEAR(found.stress[0], eta * law.stress[0], 1e-6 * law.stress[0]);
    EXPECT_EQ(point.at(1.4, 0.9).stress, elastic(1.4, 0.9).stress) << "on the way up again it is as it was there";
}

TEST(Wall, AStepOfStrainRelaxesAsAMaxwellElementBesideTheElasticLaw) {
    const double share = 0.4, tau = 2.0, g = share / (1.0 - share), theta = (1.0 - share) * tau;
    Point point("viscoelasticity", {share, tau, 2.0});
    point.at(1.0, 1.0);
    const MembranePoint after = point.at(1.2, 0.95, 1e-9), law = elastic(1.2, 0.95);
    EXPECT_NEAR(after.stress[0], (1.0 + g) * law.stress[0], 1e-5 * law.stress[0]);
    EXPECT_NEAR(after.at_once, 1.0 + g, 1e-6);
    double t = 0.0;
    for (const double dt : {0.1, 0.7, 0.05, 3.0}) {
        t += dt;
        EXPECT_NEAR(point.at(1.2, 0.95, dt).stress[0], law.stress[0] * (1.0 + g * std::exp(-t / theta)),
                    1e-6 * law.stress[0]);
    }
}

TEST(Wall, ByTheSectionAtRestWhatRelaxesIsTheForce) {
    const double share = 0.4, tau = 2.0, g = share / (1.0 - share);
    Point point("viscoelasticity", {share, tau, 1.0});
    point.at(1.0, 1.0);
    const double narrow = 0.95;
    point.at(1.2, narrow, 1e-9);
    point.at(1.2, narrow, 1e6);  // relaxed
    const double before = 1.2 * elastic(1.2, narrow).stress[0], law = 1.5 * elastic(1.5, narrow).stress[0];
    const MembranePoint after = point.at(1.5, narrow, 1e-9);
    EXPECT_NEAR(1.5 * after.stress[0], law + g * (law - before), 1e-5 * law);
}

TEST(Wall, ByTheLengthAtRestCreepAddsUpAndTheForceIsThatOfTheElasticPart) {
    Point point("creep", {0.05, 2.0, 1.0});
    double flowed = 0.0;
    for (int k = 0; k < 400; ++k) {
        point.at(1.1 + flowed, 1.0, 0.05);
        flowed += 0.1 - (std::sqrt(point.ask(1.1 + flowed, 1.0).c[0]) - 1.0);
    }
    EXPECT_NEAR(flowed, 0.05 * 0.1 * std::log(1.0 + 20.0 / 2.0), 1e-6);
    const double along = 1.1 + flowed;
    EXPECT_NEAR(along * point.ask(along, 1.0).stress[0], 1.1 * elastic(1.1, 1.0).stress[0], 1e-6);
}

TEST(Wall, MeasuresOfStrainGoIntoOneAnotherAndStressDoesTheSameWorkInEach) {
    const Vec3 c(1.7, 0.8, 0.3), more = c + 1e-6 * Vec3(0.4, 0.9, -0.2), s(30.0, -12.0, 7.0);
    const auto twice = [](const Vec3& a, const Vec3& b) { return a[0] * b[0] + a[1] * b[1] + 2.0 * a[2] * b[2]; };
    for (const double m : {2.0, 1.0, 0.3, 0.0}) {
        const StrainMeasure measure(m);
        EXPECT_LT((measure.c(measure.strain(c)) - c).norm(), 1e-9) << m;
        EXPECT_LT((measure.second_piola(measure.stress(s, c), c) - s).norm(), 1e-9) << m;
        // Of a stress with the strain's own axes: S = C.
        const double work = twice(c, 0.5 * (more - c));
        EXPECT_NEAR(twice(measure.stress(c, c), measure.strain(more) - measure.strain(c)), work, 1e-4 * std::fabs(work))
            << m;
    }
    EXPECT_NEAR(StrainMeasure(1.0).strain(Vec3(1.21, 1.0, 0.0))[0], 0.1, 1e-9);
    EXPECT_NEAR(StrainMeasure(0.0).strain(Vec3(1.21, 1.0, 0.0))[0], std::log(1.1), 1e-9);
}

TEST(Wall, ChainsOfAFiniteLengthAreGents) {
    Point point("chain_limit", {0.1});
    const double along = 1.6, across = 0.8, i1 = along * along + across * across + 1.0 / std::pow(along * across, 2);
    EXPECT_NEAR(point.at(along, across).stress[0], elastic(along, across).stress[0] / (1.0 - 0.1 * (i1 - 3.0)), 1e-9);
}

TEST(Wall, EntanglementIsMooneysSecondTerm) {
    const auto effect = find_effect("entanglement")->make(std::vector<double>{0.5});
    Effect* const effects[1] = {effect.get()};
    const MembraneMaterial kept{100.0, 0.4999 / 0.5001, Vec2::Zero()};  // keeps its volume
    for (const double stress : {-150.0, 80.0, 250.0}) {
        Uniaxial at;
        ASSERT_TRUE(
            uniaxial_rest([&](MembranePoint& p) { ask_membrane(effects, {}, kept, {}, p); }, 450.0, stress, at));
        const double l = at.along;
        EXPECT_NEAR(100.0 * (1.0 + 0.5 / l) * (l - 1.0 / (l * l)), stress, 2e-3 * std::fabs(stress));
    }
}

TEST(Wall, GripsStickThenSlideAndStayWhereTheyWere) {
    const auto effect = find_effect("boundary_slip")->make(std::vector<double>{0.01, 20.0});
    const auto slipped = [&](double traction) {
        HeldPoint held;
        held.traction = Vec3(traction, 0.0, 0.0);
        effect->slip({}, held);
        effect->remember_slip({}, held);
        return held.slipped.x();
    };
    EXPECT_EQ(slipped(15.0), 0.0);
    EXPECT_NEAR(slipped(50.0), 0.3, 1e-12);
    EXPECT_NEAR(slipped(20.0), 0.3, 1e-12) << "it comes back by friction alone";
    EXPECT_NEAR(slipped(0.0), 0.2, 1e-12);
}

TEST(Wall, TissueIsAFoundation) {
    const auto effect = find_effect("tissue_support")->make(std::vector<double>{3.0});
    std::vector<double> around{0.0, 1.0};
    effect->surroundings({}, around);
    EXPECT_EQ(around, (std::vector<double>{3.0, 4.0}));
}

}  // namespace
}  // namespace cathlab
