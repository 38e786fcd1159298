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
