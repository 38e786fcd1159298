// Effects of heart, body and sensor, each against the closed form of its law.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/units.h"
#include "effects/effect.h"
#include "effects/without_strength.h"

namespace cathlab {
namespace {

std::unique_ptr<Effect> made(const char* name, const std::vector<double>& values) {
    return find_effect(name)->make(values);
}

Drive driven(Effect& effect, const EffectContext& context) {
    Drive drive;
    drive.support_displacement.assign(context.wall_rest.size(), Vec3::Zero());
    effect.drive(context, drive);
    return drive;
}

EffectContext at_beat(std::int64_t beat, double interval = 0.0) {
    EffectContext context;
    context.heart_beats = beat;
    context.heart_beat_s = 0.9;
    context.heart_interval = interval;
    return context;
}

TEST(Alternans, EvenBeatsGainWhatOddOnesLose) {
    const auto effect = made("alternans", {0.2});
    EXPECT_DOUBLE_EQ(driven(*effect, at_beat(4)).heart_amplitude_scale, 1.2);
    EXPECT_DOUBLE_EQ(driven(*effect, at_beat(5)).heart_amplitude_scale, 0.8);
}

TEST(AmplitudeDrift, GrowsInAStraightLineAndNeverTurnsRound) {
    const auto effect = made("amplitude_drift", {-0.5});
    EffectContext context;
    context.time_s = 60.0;
    EXPECT_NEAR(driven(*effect, context).heart_amplitude_scale, 0.5, 1e-12);
    context.time_s = 600.0;
    EXPECT_DOUBLE_EQ(driven(*effect, context).heart_amplitude_scale, 0.0);
}

TEST(RateVariability, TheRateIsUsualOnAverageOverAPeriod) {
    const auto effect = made("rate_variability", {0.1, 5.0, 0.3});
    double sum = 0.0, most = 0.0;
    for (int k = 0; k < 250; ++k) {
        EffectContext context;
        context.time_s = 0.02 * k;
        context.dt = 0.02;
        const double scale = driven(*effect, context).heart_rate_scale;
        sum += scale / 250.0;
        most = std::max(most, scale);
    }
    EXPECT_NEAR(sum, 1.0, 1e-9);
    EXPECT_NEAR(most, 1.1, 1e-3);
}

TEST(BaselineWander, MovesAllSupportsByASine) {
    const auto effect = made("baseline_wander", {1.0, -2.0, 3.0, 8.0, 0.0});
    const std::vector<Vec3> rest{Vec3::Zero(), Vec3(0, 0, -400)};
    EffectContext context;
    context.wall_rest = rest;
    context.time_s = 2.0;  // a quarter
    for (const Vec3& u : driven(*effect, context).support_displacement)
        EXPECT_NEAR((u - Vec3(1.0, -2.0, 3.0)).norm(), 0.0, 1e-12);
}

TEST(EctopicBeats, AnEarlyBeatIsWeakerAndTheOneAfterThePauseStronger) {
    const auto effect = made("ectopic_beats", {1.5, 0.4, 8.0});
    EXPECT_NEAR(driven(*effect, at_beat(3, 0.6)).heart_amplitude_scale, 1.0 - 1.5 * 0.4, 1e-12);
    EXPECT_NEAR(driven(*effect, at_beat(4, 1.4)).heart_amplitude_scale, 1.0 + 1.5 * 0.4, 1e-12);
    EXPECT_DOUBLE_EQ(driven(*effect, at_beat(3, 0.6)).heart_rate_scale, 1.0);  // the recording has its own beats
}

TEST(EctopicBeats, TheRhythmGoesOnAsIfNothingHadBeen) {
    const auto effect = made("ectopic_beats", {1.0, 0.4, 8.0});
    double group = 0.0;  // lengths of the beats of one group, in usual ones
    for (std::int64_t beat = 8; beat < 16; ++beat) group += 1.0 / driven(*effect, at_beat(beat)).heart_rate_scale;
    EXPECT_NEAR(group, 8.0, 1e-12);
    EXPECT_NEAR(driven(*effect, at_beat(8)).heart_amplitude_scale, 0.6, 1e-12);
    EXPECT_NEAR(driven(*effect, at_beat(9)).heart_amplitude_scale, 1.4, 1e-12);
    EXPECT_NEAR(driven(*effect, at_beat(10)).heart_amplitude_scale, 1.0, 1e-12);
}

TEST(Respiration, InspirationTakesItsPartOfTheBreath) {
    const std::vector<Vec3> rest{Vec3::Zero()};
    const auto effect = made("respiration", {10.0, 4.0, 0.0, 0.0, 0.0, 1.0, -100.0, -300.0, 1.0, 0.3, 0.0, 0.0});
    EffectContext context;
    context.wall_rest = rest;
    context.time_s = 0.3 * 4.0;
    EXPECT_NEAR(driven(*effect, context).support_displacement[0].z(), 10.0, 1e-9);
    context.time_s = 0.15 * 4.0;
    EXPECT_NEAR(driven(*effect, context).support_displacement[0].z(), 5.0, 1e-9);
    context.time_s = 0.65 * 4.0;
    EXPECT_NEAR(driven(*effect, context).support_displacement[0].z(), 5.0, 1e-9);
}

Channels read(Effect& effect, double time_s, double dt, const Vec3& tip, double annulus = 0.0) {
    EffectContext context;
    context.dt = dt;
    context.time_s = time_s - dt;
    Channels channels;
    channels.catheter_tip_x_mm = tip.x();
    channels.catheter_tip_y_mm = tip.y();
    channels.catheter_tip_z_mm = tip.z();
    channels.annulus_displacement_mm = annulus;
    effect.measure(context, channels);
    return channels;
}

TEST(Registration, TurnsAndShiftsEveryPlace) {
    const auto effect = made("registration", {0.0, 0.0, 60.0, 1.0, 2.0, 3.0});
    const Channels c = read(*effect, 0.0, 0.0, Vec3(10.0, 0.0, 5.0));
    EXPECT_NEAR(c.catheter_tip_x_mm, 10.0 * std::cos(60.0 * units::deg) + 1.0, 1e-9);
    EXPECT_NEAR(c.catheter_tip_y_mm, 10.0 * std::sin(60.0 * units::deg) + 2.0, 1e-9);
    EXPECT_NEAR(c.catheter_tip_z_mm, 8.0, 1e-9);
}

TEST(SensorLatency, TellsWhereTheTipWasAlsoBetweenRows) {
    const auto effect = made("sensor_latency", {0.25});
    Channels c;
    for (int k = 0; k <= 20; ++k)
        c = read(*effect, 0.1 * k, k > 0 ? 0.1 : 0.0, Vec3(10.0 * 0.1 * k, 0.0, 0.0), 0.1 * k);
    EXPECT_NEAR(c.catheter_tip_x_mm, 10.0 * (2.0 - 0.25), 1e-9);
    EXPECT_NEAR(c.annulus_displacement_mm, 2.0 - 0.25, 1e-9);
}

TEST(SensorDrift, CreepsByItsRate) {
    const auto effect = made("sensor_drift", {6.0, -12.0, 3.0});
    const Channels c = read(*effect, 30.0, 0.02, Vec3(1.0, 1.0, 1.0));
    EXPECT_NEAR(c.catheter_tip_x_mm, 4.0, 1e-12);
    EXPECT_NEAR(c.catheter_tip_y_mm, -5.0, 1e-12);
    EXPECT_NEAR(c.catheter_tip_z_mm, 2.5, 1e-12);
    EXPECT_NEAR(c.annulus_displacement_mm, 1.5, 1e-12);
}

/// Where a support that breathes by 10 mm in 4 s is at a time, mm.
double breathed(double dwell, double rest, double held_until_s, double time_s) {
    const std::vector<Vec3> place{Vec3::Zero()};
    const auto effect =
        made("respiration", {10.0, 4.0, 0.0, 0.0, 0.0, 1.0, -100.0, -300.0, dwell, 0.5, rest, held_until_s});
    EffectContext context;
    context.wall_rest = place;
    context.time_s = time_s;
    return driven(*effect, context).support_displacement[0].z();
}

TEST(Respiration, AHeldBreathStandsWhereItThenSetsIn) {
    const auto curve = [](double time_s) { return 10.0 * std::pow(std::sin(units::pi * time_s / 4.0), 2); };
    for (const double t : {0.0, 0.4, 1.3}) EXPECT_NEAR(breathed(1.0, 0.0, 1.3, t), curve(1.3), 1e-9);
    for (const double t : {1.31, 2.8, 9.1}) EXPECT_NEAR(breathed(1.0, 0.0, 1.3, t), curve(t), 1e-9);
}

TEST(Respiration, LiesStillForThePartOfTheCurveThatIsItsRest) {
    // A sine that is cut at a quarter of its height rests for a third of its period and comes as far as ever.
    for (const double t : {0.0, 0.3, 0.66, 3.34, 3.9}) EXPECT_EQ(breathed(1.0, 0.25, 0.0, t), 0.0) << t;
    EXPECT_NEAR(breathed(1.0, 0.25, 0.0, 2.0), 10.0, 1e-9);
    EXPECT_NEAR(breathed(1.0, 0.25, 0.0, 1.0), 10.0 / 3.0, 1e-9);
}

TEST(RegionalMotion, BeginsEveryBeatWhereItStandsAndGoesTwiceRoundInIt) {
    const std::vector<Vec3> rest{Vec3::Zero(), Vec3(0, 0, -400)};
    const auto effect = made("regional_motion", {1.0, 0.0, 0.0, 0.0, 2.0, 0.0, 0.0, 0.0, 3.0, 0.0, 0.0, -4.0});
    EffectContext context = at_beat(2);
    context.wall_rest = rest;
    const auto at = [&](double phase) {
        context.heart_phase = phase;
        return driven(*effect, context).support_displacement[1];
    };
    EXPECT_NEAR(at(0.0).norm(), 0.0, 1e-12);
    EXPECT_NEAR((at(0.25) - Vec3(-1.0, 2.0, -6.0)).norm(), 0.0, 1e-9);
    EXPECT_NEAR((at(0.5) - Vec3(-2.0, 0.0, 0.0)).norm(), 0.0, 1e-9);
    EXPECT_NEAR(at(0.125).z(), -3.0 - 4.0, 1e-9);
    context.heart_beat_s = 0.0;  // no heart
    EXPECT_EQ(at(0.25).norm(), 0.0);
}

TEST(FieldDistortion, GrowsWithTheSquareOfTheDistance) {
    const auto effect = made("field_distortion", {1.0, 0.5, 0.0, -0.25});
    Channels c = read(*effect, 0.0, 0.0, Vec3(200.0, 0.0, 0.0));
    EXPECT_NEAR(c.catheter_tip_x_mm, 200.0 + 4.0 * (0.5 + 1.0), 1e-12);
    EXPECT_NEAR(c.catheter_tip_z_mm, 4.0 * -0.25, 1e-12);
    c = read(*effect, 0.0, 0.0, Vec3(0.0, -50.0, 0.0));
    EXPECT_NEAR(c.catheter_tip_y_mm, -50.0 - 0.25, 1e-12);
    c = read(*effect, 0.0, 0.0, Vec3::Zero());
    EXPECT_EQ(c.catheter_tip_x_mm, 0.0);
}

TEST(Strengths, OfHeartBodyAndSensorAreNothingWhenZero) {
    const std::vector<Vec3> rest{Vec3::Zero(), Vec3(0, 0, -200)};
    effects_test::for_each_without_strength(hook_drive | hook_measure, [&](const EffectInfo& info, const auto& values) {
        const auto effect = info.make(values);
        EffectContext context = at_beat(5);
        context.wall_rest = rest;
        for (const double t : {0.0, 1.0, 3.7}) {
            context.time_s = t;
            const Drive drive = driven(*effect, context);
            for (const Vec3& u : drive.support_displacement) EXPECT_EQ(u.norm(), 0.0) << info.name;
            EXPECT_EQ(drive.heart_amplitude_scale, 1.0) << info.name;
            EXPECT_EQ(drive.heart_displacement_mm, 0.0) << info.name;
            const Channels c = read(*effect, t, 0.1, Vec3(3.0 + t, 4.0, 5.0));
            EXPECT_EQ(c.catheter_tip_x_mm, 3.0 + t) << info.name;
            EXPECT_EQ(c.catheter_tip_z_mm, 5.0) << info.name;
        }
    });
}

}  // namespace
}  // namespace cathlab
