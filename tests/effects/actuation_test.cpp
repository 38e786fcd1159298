// Effects between drive and catheter, each against the closed form of its law.
#include <gtest/gtest.h>

#include <cmath>

#include "core/units.h"
#include "effects/effect.h"
#include "effects/without_strength.h"

namespace cathlab {
namespace {

/// Calls an effect as a step does, with one or two segments that bend along x.
class Bench {
public:
    Bench(const char* name, std::vector<double> values, double dt = 0.02)
        : effect_(find_effect(name)->make(values)), dt_(dt) {}

    Actuation operator()(std::vector<double> bends_deg, double rotation_deg = 0.0, double insertion_mm = 0.0,
                         const Vec3& down = Vec3::Zero()) {
        Actuation act;
        act.insertion_mm = insertion_mm;
        act.rotation_rad = rotation_deg * units::deg;
        act.down = down;
        for (const double bend : bends_deg) {
            ActuatedSegment segment;
            segment.length_mm = 30.0;
            segment.bend_rad = Vec2(bend * units::deg, 0.0);
            act.segments.push_back(segment);
        }
        EffectContext context;
        context.time_s = time_;
        context.dt = time_ == 0.0 ? 0.0 : dt_;
        effect_->actuation(context, act);
        time_ += dt_;
        return act;
    }
    double bend_deg(double command) { return (*this)({command}).segments[0].bend_rad.x() / units::deg; }

private:
    std::unique_ptr<Effect> effect_;
    double dt_, time_ = 0.0;
};

TEST(Strengths, AnEffectWhoseStrengthsAreAllZeroDoesNothingToTheBit) {
    effects_test::for_each_without_strength(hook_actuation, [](const EffectInfo& info, const auto& values) {
        Bench bench(info.name.data(), values);
        for (const double bend : {0.0, 20.0, 35.0, -10.0, 5.0}) {
            const Actuation act = bench({bend, 2.0 * bend}, 3.0 * bend, bend, Vec3(0.0, -1.0, 0.0));
            EXPECT_EQ(act.segments[0].bend_rad, Vec2(bend * units::deg, 0.0)) << info.name;
            EXPECT_EQ(act.segments[1].bend_rad, Vec2(2.0 * bend * units::deg, 0.0)) << info.name;
            EXPECT_EQ(act.segments[0].taper, 0.0) << info.name;
            EXPECT_EQ(act.rotation_rad, 3.0 * bend * units::deg) << info.name;
            EXPECT_EQ(act.insertion_mm, bend) << info.name;
            EXPECT_EQ(act.tip_compliance_mm_per_n, 0.0) << info.name;
        }
    });
}

TEST(Backlash, LosesItsWidthAtEveryReversal) {
    Bench bench("backlash", {0.0, 6.0, 4.0, 0.0, 0.0});
    EXPECT_DOUBLE_EQ(bench.bend_deg(0.0), 0.0);
    EXPECT_DOUBLE_EQ(bench.bend_deg(1.9), 0.0);      // within half the gap
    EXPECT_NEAR(bench.bend_deg(30.0), 28.0, 1e-12);  // dragged by the edge
    EXPECT_NEAR(bench.bend_deg(26.5), 28.0, 1e-12);  // 3.5 of 4 deg lost so far
    EXPECT_NEAR(bench.bend_deg(20.0), 22.0, 1e-12);  // the other edge
    EXPECT_NEAR(bench({20.0}, 50.0).rotation_rad / units::deg, 47.0, 1e-12);
    EXPECT_NEAR(bench({20.0}, 45.0).rotation_rad / units::deg, 47.0, 1e-12);
}

TEST(Hysteresis, IsTheMeanOfItsPlaysAndClosesItsLoops) {
    constexpr double share = 0.4, width = 30.0;
    Bench bench("hysteresis", {share, 0.0, 0.0, width});
    bench.bend_deg(0.0);
    // All six plays are at an edge beyond their widths: behind by the mean radius, 7/12 of the widest.
    EXPECT_NEAR(bench.bend_deg(60.0), 60.0 - share * width * 7.0 / 12.0, 1e-9);
    const double there = bench.bend_deg(40.0);
    bench.bend_deg(48.0);
    EXPECT_NEAR(bench.bend_deg(40.0), there, 1e-9);  // a minor loop closes
    EXPECT_NEAR(bench.bend_deg(-60.0), -60.0 + share * width * 7.0 / 12.0, 1e-9);
}

TEST(ActuationLag, FollowsAStepByAnExponentialAndARampOneTimeConstantBehind) {
    constexpr double tau = 0.5, dt = 0.02;
    Bench ramp("actuation_lag", {tau, 0.0, 0.0}, dt);
    double last = 0.0;
    for (int k = 0; k <= 500; ++k) last = ramp.bend_deg(10.0 * k * dt);
    EXPECT_NEAR(last, 10.0 * (500 * dt - tau), 1e-6);
    // Exact whatever the step: a ramp of one second in one call or in fifty.
    Bench once("actuation_lag", {tau, 0.0, 0.0}, 1.0), often("actuation_lag", {tau, 0.0, 0.0}, dt);
    once.bend_deg(0.0);
    often.bend_deg(0.0);
    for (int k = 1; k <= 50; ++k) last = often.bend_deg(20.0 * k * dt);
    EXPECT_NEAR(once.bend_deg(20.0), last, 1e-10);
    EXPECT_NEAR(last, 20.0 * (1.0 - tau + tau * std::exp(-1.0 / tau)), 1e-10);
}

TEST(SegmentCoupling, EachSegmentTakesItsPartOfItsNeighbours) {
    Bench bench("segment_coupling", {0.2, 0.05, 0.1});
    const Actuation act = bench({10.0, 20.0, 40.0});
    EXPECT_NEAR(act.segments[0].bend_rad.x() / units::deg, 10.0 + 0.2 * 20.0 + 0.05 * 40.0, 1e-12);
    EXPECT_NEAR(act.segments[1].bend_rad.x() / units::deg, 20.0 + 0.2 * 40.0 + 0.1 * 10.0, 1e-12);
    EXPECT_NEAR(act.segments[2].bend_rad.x() / units::deg, 40.0 + 0.1 * 20.0, 1e-12);
}

TEST(ActuationGain, MultipliesEveryAxis) {
    Bench bench("actuation_gain", {0.1, -0.2, 0.3, 0.0, -0.4});
    const Actuation act = bench({10.0, 20.0}, 50.0, 30.0);
    EXPECT_NEAR(act.insertion_mm, 33.0, 1e-12);
    EXPECT_NEAR(act.rotation_rad / units::deg, 40.0, 1e-12);
    EXPECT_NEAR(act.segments[0].bend_rad.x() / units::deg, 13.0, 1e-12);
    EXPECT_NEAR(act.segments[1].bend_rad.x() / units::deg, 12.0, 1e-12);
}

TEST(GravitySag, TurnsTheTipOfALevelCantileverAsBeamTheorySays) {
    constexpr double drop = 3.0, length = 30.0;
    Bench bench("gravity_sag", {drop});
    const Actuation act = bench({0.0}, 0.0, 0.0, Vec3(0.0, -1.0, 0.0));
    // Slope at the end of a cantilever under its own weight: w L^3 / (6 EI) = 4/3 drop / L.
    EXPECT_NEAR(-act.segments[0].bend_rad.y(), 4.0 / 3.0 * drop / length, 0.01 * 4.0 / 3.0 * drop / length);
    EXPECT_NEAR(act.segments[0].bend_rad.x(), 0.0, 1e-15);
    // Hanging straight down nothing bends.
    Bench hanging("gravity_sag", {drop});
    EXPECT_NEAR(hanging({0.0}, 0.0, 0.0, Vec3::UnitZ()).segments[0].bend_rad.norm(), 0.0, 1e-15);
}

TEST(RestMemory, ComesBackShortOfItsLastExcursion) {
    constexpr double share = 0.2, per_deg = 0.05;
    Bench bench("rest_memory", {share, 0.0, 0.0, per_deg, 0.0});
    bench.bend_deg(0.0);
    bench.bend_deg(400.0);  // held far away: the memory lags 1 / per_deg behind
    const double memory = 400.0 - (1.0 - std::exp(-per_deg * 400.0)) / per_deg;
    const double back = bench.bend_deg(390.0);
    const double kept = std::exp(-per_deg * 10.0);
    const double now = 390.0 + 1.0 / per_deg + kept * (memory - 400.0 - 1.0 / per_deg);
    EXPECT_NEAR(back, 390.0 + share * (now - 390.0), 1e-9);
}

TEST(TendonSlack, APulledTendonBendsAloneAndThosePaidOutGoSlack) {
    Actuation act;
    ActuatedSegment segment;
    segment.tendon_radius_mm = 5.0;
    segment.tendon_mm = {4.0, -9.0, -9.0};
    Vec2 ideal = Vec2::Zero();
    for (int k = 0; k < 3; ++k) {
        const double place = 2.0 * units::pi * k / 3.0;
        segment.tendon_rad.push_back(place);
        ideal += 2.0 / 15.0 * segment.tendon_mm[static_cast<std::size_t>(k)] * Vec2(std::cos(place), std::sin(place));
    }
    segment.bend_rad = ideal;
    act.segments = {segment};
    find_effect("tendon-slack")->make(std::vector<double>{1.0, 0.0})->actuation({}, act);
    EXPECT_NEAR(act.segments[0].bend_rad.x(), 4.0 / 5.0, 1e-9);  // arc of the one that is taut
    EXPECT_NEAR(act.segments[0].bend_rad.y(), 0.0, 1e-9);
    // Tendons that all follow the bend are taut, and nothing changes.
    const Vec2 bend(0.3, -0.2);
    segment.bend_rad = bend;
    for (std::size_t k = 0; k < 3; ++k)
        segment.tendon_mm[k] = 5.0 * bend.dot(Vec2(std::cos(segment.tendon_rad[k]), std::sin(segment.tendon_rad[k])));
    act.segments = {segment};
    find_effect("tendon_slack")->make(std::vector<double>{1.0, 0.0})->actuation({}, act);
    EXPECT_NEAR((act.segments[0].bend_rad - bend).norm(), 0.0, 1e-9);
}

TEST(TorsionWindup, TheTipTurnsWhenTheShaftIsWoundUpWhichGrowsWithItsLength) {
    Bench bench("torsion_windup", {2.0, 10.0});
    const auto tip_deg = [&](double drive, double insertion) {
        return bench({0.0}, drive, insertion).rotation_rad / units::deg;
    };
    EXPECT_DOUBLE_EQ(tip_deg(0.0, 100.0), 0.0);
    EXPECT_DOUBLE_EQ(tip_deg(11.0, 100.0), 0.0);  // 2 + 10 are held
    EXPECT_NEAR(tip_deg(30.0, 100.0), 18.0, 1e-12);
    EXPECT_NEAR(tip_deg(20.0, 100.0), 18.0, 1e-12);
    EXPECT_NEAR(tip_deg(-10.0, 100.0), 2.0, 1e-12);
    EXPECT_NEAR(tip_deg(-30.0, 200.0), -8.0, 1e-12);  // 2 + 20
}

TEST(CurvatureTaper, EachSegmentHasItsOwnAndTheyAddUp) {
    Bench bench("curvature_taper", {0.5, -0.2, 0.1});
    const Actuation act = bench({10.0, 20.0, 30.0});
    EXPECT_DOUBLE_EQ(act.segments[0].taper, 0.5);
    EXPECT_DOUBLE_EQ(act.segments[1].taper, -0.2);
    EXPECT_DOUBLE_EQ(act.segments[2].taper, 0.1);
    for (std::size_t i = 0; i < 3; ++i)
        EXPECT_NEAR(act.segments[i].bend_rad.x() / units::deg, 10.0 * (static_cast<double>(i) + 1.0), 1e-12);
    find_effect("curvature_taper")
        ->make(std::vector<double>{0.1, 0.1, 0.1})
        ->actuation({}, const_cast<Actuation&>(act));
    EXPECT_DOUBLE_EQ(act.segments[1].taper, -0.1);
}

TEST(TipCompliance, AddsItsOwnToWhatIsThere) {
    Actuation act;
    act.tip_compliance_mm_per_n = 1.5;
    find_effect("tip_compliance")->make(std::vector<double>{4.0})->actuation({}, act);
    EXPECT_DOUBLE_EQ(act.tip_compliance_mm_per_n, 5.5);
}

TEST(TendonRouting, TwoSegmentsShareTheDistalTendonsPull) {
    for (const double give : {0.01, 0.5, 4.0}) {
        Bench bench("tendon_routing", {1.0, give});
        const double a = 20.0, b = -30.0;
        const Actuation act = bench({a, b});
        // The gradient of the law's energy by hand: (give + 2) x + y = (1 + give) (a + b), x + (1 + give) y = (1 +
        // give) b.
        const double g1 = 1.0 + give, d = (give + 2.0) * g1 - 1.0;
        EXPECT_NEAR(act.segments[0].bend_rad.x() / units::deg, g1 * (g1 * (a + b) - b) / d, 1e-9);
        EXPECT_NEAR(act.segments[1].bend_rad.x() / units::deg, g1 * ((give + 2.0) * b - (a + b)) / d, 1e-9);
    }
    Bench alone("tendon_routing", {1.0, 0.5});
    EXPECT_NEAR(alone.bend_deg(25.0), 25.0, 1e-12);
}

/// A segment whose `pulled` (mm) tendons stand evenly around, and which its drive bends as ideal tendons would.
ActuatedSegment tendons(const std::vector<double>& pulled, double radius_mm) {
    ActuatedSegment out;
    out.tendon_radius_mm = radius_mm;
    out.tendon_mm = pulled;
    const auto n = static_cast<double>(pulled.size());
    for (std::size_t k = 0; k < pulled.size(); ++k) {
        const double place = 2.0 * units::pi * static_cast<double>(k) / n;
        out.tendon_rad.push_back(place);
        out.bend_rad += 2.0 / (n * radius_mm) * pulled[k] * Vec2(std::cos(place), std::sin(place));
    }
    return out;
}

TEST(TendonStretch, TautTendonsShareTheBendWithTheSegmentAsSpringsInARow) {
    // Four taut tendons hold with 2 (in units of one), the segment resists with `give`; a straight rest shape.
    for (const double give : {0.1, 1.0, 5.0}) {
        Actuation act;
        act.segments = {tendons({1.5, 0.5, -1.5, -0.5}, 5.0)};
        const Vec2 asked = act.segments[0].bend_rad;
        find_effect("tendon-stretch")->make(std::vector<double>{1.0, give, 8.0})->actuation({}, act);
        EXPECT_NEAR((act.segments[0].bend_rad - 2.0 / (2.0 + give) * asked).norm(), 0.0, 1e-12);
    }
}

TEST(TendonStretch, ATendonThatIsPaidOutDoesNotPush) {
    Actuation act;
    act.segments = {tendons({4.0, -9.0, -9.0}, 5.0)};
    find_effect("tendon-stretch")->make(std::vector<double>{1.0, 0.25, 0.0})->actuation({}, act);
    EXPECT_NEAR(act.segments[0].bend_rad.x(), 4.0 / 5.0 / 1.25, 1e-12);
    EXPECT_NEAR(act.segments[0].bend_rad.y(), 0.0, 1e-12);
}

TEST(TendonStretch, ADistalTendonBendsEverySegmentThatItRunsThrough) {
    const double give = 0.6, pulled = 3.0, radius = 5.0;
    Actuation act;
    act.segments = {tendons({-9.0, -9.0, -9.0}, radius), tendons({-9.0, -9.0, -9.0}, radius),
                    tendons({pulled, -9.0, -9.0}, radius)};
    const auto effect = find_effect("tendon-stretch")->make(std::vector<double>{1.0, give, 0.0});
    effect->actuation({}, act);
    for (const ActuatedSegment& s : act.segments)
        EXPECT_NEAR((s.bend_rad - Vec2(pulled / radius / (give + 3.0), 0.0)).norm(), 0.0, 1e-12);
    // A rest shape of the drive stays where nothing pulls.
    act.segments = {tendons({-2.0, -2.0, -2.0}, radius)};
    act.segments[0].bend_rad += Vec2(0.1, 0.2);
    find_effect("tendon-stretch")->make(std::vector<double>{1.0, give, 0.0})->actuation({}, act);
    EXPECT_NEAR((act.segments[0].bend_rad - Vec2(0.1, 0.2)).norm(), 0.0, 1e-12);
}

}  // namespace
}  // namespace cathlab
