// Effects between drive and catheter, each against the closed form of its law.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/units.h"
#include "effects/effect.h"

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
    for (const EffectInfo& info : effect_table()) {
        if ((info.hooks & hook_actuation) == 0 || info.for_tests) continue;
        ASSERT_FALSE(info.strengths.empty()) << info.name;
        std::vector<double> values;
        for (const Parameter& p : info.parameters) {
            const bool strength =
                std::find(info.strengths.begin(), info.strengths.end(), p.key) != info.strengths.end();
            values.push_back(strength ? 0.0 : p.default_value);
        }
        Bench bench(info.name.data(), values);
        for (const double bend : {0.0, 20.0, 35.0, -10.0, 5.0}) {
            const Actuation act = bench({bend, 2.0 * bend}, 3.0 * bend, bend, Vec3(0.0, -1.0, 0.0));
            EXPECT_EQ(act.segments[0].bend_rad, Vec2(bend * units::deg, 0.0)) << info.name;
            EXPECT_EQ(act.segments[1].bend_rad, Vec2(2.0 * bend * units::deg, 0.0)) << info.name;
            EXPECT_EQ(act.rotation_rad, 3.0 * bend * units::deg) << info.name;
            EXPECT_EQ(act.insertion_mm, bend) << info.name;
        }
    }
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

}  // namespace
}  // namespace cathlab
