#include "beam/exposure.h"

#include <gtest/gtest.h>

#include <cmath>

using namespace cathlab;

TEST(Beam, PulsesComeAtTheirRateAndDependOnTheStepAlone) {
    for (const double rate : {7.5, 15.0, 30.0}) {
        int pulses = 0;
        for (int step = 0; step < 3000; ++step) pulses += pulse_in_step(step, 0.02, rate);
        EXPECT_EQ(pulses, static_cast<int>(rate * 60.0));
    }
    EXPECT_TRUE(pulse_in_step(9, 0.02, 15.0));  // the third of a second's fifteen ends at 0.2 s
}

TEST(Beam, DoseGrowsOnlyWhileThePedalIsDown) {
    const BeamSpec spec;
    BeamState state = initial_state(spec);
    for (int step = 0; step < 100; ++step) EXPECT_FALSE(advance(spec, state, {0, 0, false}, 200.0, step, 0.02));
    EXPECT_EQ(state.air_kerma_mgy, 0.0);
    EXPECT_EQ(state.frames, 0);
    for (int step = 100; step < 150; ++step) advance(spec, state, {0, 0, true}, 200.0, step, 0.02);
    EXPECT_EQ(state.frames, 15);
    EXPECT_NEAR(state.beam_time_s, 1.0, 1e-12);
    EXPECT_GT(state.dose_area_gycm2, 0.0);
    const BeamState held = state;
    for (int step = 150; step < 200; ++step) advance(spec, state, {0, 0, false}, 200.0, step, 0.02);
    EXPECT_EQ(state.air_kerma_mgy, held.air_kerma_mgy);
    EXPECT_EQ(state.dose_area_gycm2, held.dose_area_gycm2);
    EXPECT_EQ(state.kerma_rate_mgy_min, 0.0);
}

TEST(Beam, TheDetectorGetsItsTargetOnceTheControlHasSettled) {
    const BeamSpec spec;
    for (const double water : {80.0, 150.0, 200.0, 240.0})
        EXPECT_NEAR(expose(spec, water, water).detector_kerma_ngy, 40.0, 1e-9);
    // Thicker than the tube's limits reach: the frame darkens and the entrance rate stays at its limit.
    const Pulse thick = expose(spec, 450.0, 450.0);
    EXPECT_LT(thick.detector_kerma_ngy, 20.0);
    EXPECT_LE(thick.reference_kerma_mgy * 60.0 * spec.pulses_per_s, spec.kerma_rate_limit_mgy_min * (1.0 + 1e-12));
}

TEST(Beam, TheControlLagsByItsTimeConstant) {
    const BeamSpec spec;
    BeamState state = initial_state(spec);
    state.water_mm = 200.0;
    for (int step = 0; step < 25; ++step) advance(spec, state, {0, 0, true}, 260.0, step, 0.02);
    EXPECT_NEAR(state.water_mm, 260.0 - 60.0 * std::exp(-1.0), 1e-9);
    EXPECT_LT(state.detector_kerma_ngy, 40.0);  // still set for the thinner patient
}

TEST(Beam, KermaFallsWithTheSquareOfTheDistanceAndDoseAreaDoesNot) {
    BeamSpec near, far;
    near.reference_point_mm = 250.0;  // 500 mm from the focus
    far.reference_point_mm = 0.0;     // 750 mm
    const Pulse a = expose(near, 200.0, 200.0), b = expose(far, 200.0, 200.0);
    EXPECT_NEAR(a.reference_kerma_mgy / b.reference_kerma_mgy, 2.25, 1e-9);
    EXPECT_NEAR(a.dose_area_gycm2 / b.dose_area_gycm2, 1.0, 1e-12);
    BeamSpec longer;
    longer.c_arm.sid_mm = 1200.0;  // the same field at the detector, farther away: more mAs for the same kerma there
    EXPECT_NEAR(expose(longer, 200.0, 200.0).mas / expose(BeamSpec{}, 200.0, 200.0).mas, std::pow(1200.0 / 1050.0, 2),
                1e-9);
}

TEST(Beam, EntranceDoseIsThatOfRealSystems) {
    // PMMA of 16 to 28 cm: 5 to 95 mGy/min in fluoroscopy [vano2005].
    const BeamSpec spec;
    const double thin = 900.0 * expose(spec, 160.0, 160.0).reference_kerma_mgy;
    const double thick = 900.0 * expose(spec, 280.0, 280.0).reference_kerma_mgy;
    RecordProperty("mgy_min_at_16_cm", std::to_string(thin));
    RecordProperty("mgy_min_at_28_cm", std::to_string(thick));
    EXPECT_GT(thin, 3.0);
    EXPECT_LT(thick, 95.0);
    EXPECT_GT(thick, 4.0 * thin);
}

TEST(Beam, TheArmTurnsNoFasterThanItsMotor) {
    const BeamSpec spec;
    BeamState state = initial_state(spec);
    for (int step = 0; step < 50; ++step) advance(spec, state, {45.0, -90.0, false}, 200.0, step, 0.02);
    EXPECT_NEAR(state.primary_deg, 25.0, 1e-9);
    EXPECT_NEAR(state.secondary_deg, -25.0, 1e-9);
    for (int step = 0; step < 50; ++step) advance(spec, state, {45.0, std::nan(""), false}, NAN, step, 0.02);
    EXPECT_DOUBLE_EQ(state.primary_deg, 45.0);
    EXPECT_NEAR(state.secondary_deg, -25.0, 1e-9);
}

TEST(Beam, TheTableGoesNoFasterThanItsMotorAndShowsWhatLiesNearerTheHead) {
    BeamSpec spec;
    spec.isocentre = Vec3(5.0, 6.0, 7.0);
    BeamState state = initial_state(spec);
    const BeamCommand wanted{0.0, 0.0, false, 200.0, -30.0};
    for (int step = 0; step < 50; ++step) advance(spec, state, wanted, 200.0, step, 0.02);
    EXPECT_NEAR(state.table_longitudinal_mm, 150.0, 1e-9);
    EXPECT_DOUBLE_EQ(state.table_lateral_mm, -30.0);
    const Vec3 middle = isocentre_in_patient(spec, state.table_longitudinal_mm, state.table_lateral_mm);
    EXPECT_NEAR((middle - Vec3(-25.0, 6.0, 157.0)).norm(), 0.0, 1e-9);
    const CArmPose pose = c_arm_pose(spec.c_arm, middle, 30.0, -10.0);
    const Vec2 shadow = project(spec.c_arm, pose, middle);
    EXPECT_NEAR(shadow.x(), 0.5 * (spec.c_arm.columns - 1), 1e-9);
    EXPECT_NEAR(shadow.y(), 0.5 * (spec.c_arm.rows - 1), 1e-9);
}

TEST(Beam, NonsenseIsRefused) {
    BeamSpec spec;
    EXPECT_NO_THROW(validate(spec));
    spec.pulses_per_s = 14.0;
    EXPECT_THROW(validate(spec), UserError);
    spec = {};
    spec.reference_point_mm = 749.0;
    EXPECT_THROW(validate(spec), UserError);
    spec = {};
    spec.copper_mm = std::nan("");
    EXPECT_THROW(validate(spec), UserError);
}

namespace {

BeamCommand pressed(Acquisition acquisition = Acquisition::fluoroscopy) {
    BeamCommand command;
    command.pedal = true;
    command.acquisition = acquisition;
    return command;
}

// Counts and names what a state's visit shows.
class Fields : public Archive {
public:
    std::size_t count = 0;

protected:
    void numbers(std::string_view, double*, std::size_t) override { ++count; }
    void numbers(std::string_view, float*, std::size_t) override { ++count; }
    void numbers(std::string_view, std::int64_t*, std::size_t) override { ++count; }
};

std::size_t fields_of(BeamState state) {
    Fields fields;
    visit(fields, state);
    return fields.count;
}

}  // namespace

TEST(Beam, EachWayOfExposingReachesItsOwnKerma) {
    const BeamSpec spec;
    BeamState state = initial_state(spec);
    const auto kerma = [&] {
        const Technique technique = technique_of(spec, state);
        return expose(spec, 200.0, 200.0, technique).detector_kerma_ngy;
    };
    EXPECT_NEAR(kerma(), 40.0, 1e-9);
    state.level = FluoroscopyLevel::low;
    EXPECT_NEAR(kerma(), 20.0, 1e-9);
    state.level = FluoroscopyLevel::high;
    EXPECT_NEAR(kerma(), 80.0, 1e-9);
    state.acquisition = Acquisition::cine;
    EXPECT_NEAR(kerma(), 170.0, 1e-9);
    state.acquisition = Acquisition::dsa;
    EXPECT_NEAR(kerma(), 3000.0, 1e-6);
}

TEST(Beam, ASubtractionSeriesIsSlowerAndEachSeriesHasItsNumber) {
    const BeamSpec spec;
    BeamState state = initial_state(spec);
    std::int64_t step = 0;
    const auto run = [&](const BeamCommand& command, int steps) {
        const std::int64_t before = state.frames;
        for (int k = 0; k < steps; ++k, ++step) advance(spec, state, command, 200.0, step, 0.02);
        return state.frames - before;
    };
    EXPECT_EQ(run(pressed(), 100), 30);
    EXPECT_EQ(state.series, 1);
    EXPECT_EQ(run(pressed(Acquisition::dsa), 100), 15);
    EXPECT_EQ(state.series, 2);  // without letting the pedal go
    run({}, 10);
    EXPECT_EQ(state.series, 2);
    run(pressed(), 10);
    EXPECT_EQ(state.series, 3);
}

TEST(Beam, TheCollimatorTakesDoseAreaAndLeavesKerma) {
    const BeamSpec spec;
    BeamState state = initial_state(spec);
    BeamCommand command = pressed();
    command.collimator_width = 0.5;
    command.collimator_height = 0.4;
    BeamCommand closing = command;
    closing.pedal = false;
    for (int step = 0; step < 50; ++step) advance(spec, state, closing, 200.0, step, 0.02);
    EXPECT_EQ(state.collimator_width, 0.5);  // blades take their time, then stand
    EXPECT_EQ(state.collimator_height, 0.4);
    BeamState open = initial_state(spec);
    for (int step = 50; step < 100; ++step) {
        advance(spec, state, command, 200.0, step, 0.02);
        advance(spec, open, pressed(), 200.0, step, 0.02);
    }
    EXPECT_NEAR(state.dose_area_gycm2 / open.dose_area_gycm2, 0.2, 1e-12);
    EXPECT_EQ(state.air_kerma_mgy, open.air_kerma_mgy);
}

TEST(Beam, TheBladesKeepTheirSpeedAndNeverShutTheField) {
    const BeamSpec spec;
    BeamState state = initial_state(spec);
    BeamCommand command;
    command.collimator_width = -3.0;
    advance(spec, state, command, 200.0, 0, 0.02);
    EXPECT_NEAR(state.collimator_width, 0.98, 1e-12);
    for (int step = 1; step < 200; ++step) advance(spec, state, command, 200.0, step, 0.02);
    EXPECT_EQ(state.collimator_width, 0.1);
}

TEST(Beam, TheReferenceIsKeptOnceForEachPressOfItsKey) {
    const BeamSpec spec;
    BeamState state = initial_state(spec);
    BeamCommand down;
    down.reference = true;
    for (int step = 0; step < 10; ++step) advance(spec, state, down, 200.0, step, 0.02);
    EXPECT_EQ(state.references, 1);
    advance(spec, state, {}, 200.0, 10, 0.02);
    advance(spec, state, down, 200.0, 11, 0.02);
    EXPECT_EQ(state.references, 2);
}

TEST(Beam, WhatWasNeverUsedIsNoPartOfTheState) {
    const BeamSpec spec;
    BeamState state = initial_state(spec);
    for (int step = 0; step < 100; ++step) advance(spec, state, pressed(), 200.0, step, 0.02);
    EXPECT_EQ(fields_of(state), fields_of(initial_state(spec)));
    BeamState cine = state;
    advance(spec, cine, pressed(Acquisition::cine), 200.0, 100, 0.02);
    EXPECT_GT(fields_of(cine), fields_of(state));
}
