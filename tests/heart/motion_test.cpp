#include "heart/motion.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/deterministic_math.h"
#include "core/units.h"
#include "heart/cylinder_rows.h"

using namespace cathlab;

TEST(Heart, TheProfilePassesItsKnotsAndNeverOvershoots) {
    const HeartSpec spec;
    for (const HeartKnot& knot : spec.knots)
        EXPECT_NEAR(profile(spec, knot.phase).displacement_mm, knot.displacement_mm, 1e-12);
    for (double phase = 0.0; phase < 1.0; phase += 0.001) {
        EXPECT_GE(profile(spec, phase).displacement_mm, -1e-12);
        EXPECT_LE(profile(spec, phase).displacement_mm, 11.6 + 1e-12);
    }
    EXPECT_NEAR(profile(spec, 0.45).displacement_mm, 0.0, 1e-12);  // rest pose = end-systole
}

TEST(Heart, TheProfileIsPeriodicAndSmoothAndItsSlopeIsItsDerivative) {
    const HeartSpec spec;
    for (double phase = 0.0; phase < 1.0; phase += 0.0137) {
        EXPECT_NEAR(profile(spec, phase).displacement_mm, profile(spec, phase + 3.0).displacement_mm, 1e-11);
        const double e = 1e-6;
        const double slope =
            (profile(spec, phase + e).displacement_mm - profile(spec, phase - e).displacement_mm) / (2.0 * e);
        EXPECT_NEAR(profile(spec, phase).slope_mm, slope, 1e-3);
    }
    for (const HeartKnot& knot : spec.knots)
        EXPECT_NEAR(profile(spec, knot.phase - 1e-9).slope_mm, profile(spec, knot.phase + 1e-9).slope_mm, 1e-4);
}

TEST(Heart, BeatsComeAtTheirRate) {
    HeartSpec spec;
    spec.rate_bpm = 75.0;
    spec.initial_phase = 0.0;
    HeartState state = initial_state(spec);
    for (int i = 0; i < 3000; ++i) advance(spec, state, 0.02);
    EXPECT_NEAR(static_cast<double>(state.beats) + state.phase, 75.0, 1e-9);
    const double before = state.displacement_mm;
    advance(spec, state, 1e-6);
    EXPECT_NEAR((state.displacement_mm - before) / 1e-6, state.velocity_mm_s, 0.01);
    for (int i = 0; i < 100; ++i) advance(spec, state, 0.02, 0.0);
    EXPECT_NEAR(state.velocity_mm_s, 0.0, 1e-12);
}

TEST(Heart, TheCylinderPushesIntoTheAortaAlongTheAnnulusAxis) {
    HeartSpec spec;
    spec.rest_gap_mm = 1.0;
    Pose annulus;
    annulus.position = Vec3(5, 6, 7);
    annulus.orientation = det::rotation_from_vector(Vec3(0.0, units::pi / 2.0, 0.0));  // z of the annulus = world x
    const Pose pose = cylinder_pose(spec, annulus, 4.0);
    EXPECT_NEAR((pose.position - Vec3(8, 6, 7)).norm(), 0.0, 1e-12);
    EXPECT_NEAR((pose.orientation * Vec3::UnitZ() - Vec3::UnitX()).norm(), 0.0, 1e-12);
}

TEST(Heart, NonsenseIsRefusedByName) {
    HeartSpec spec;
    EXPECT_NO_THROW(validate(spec));
    spec.rate_bpm = std::nan("");
    EXPECT_THROW(validate(spec), UserError);
    spec = {};
    spec.knots[3].phase = 0.1;
    EXPECT_THROW(validate(spec), UserError);
    spec = {};
    spec.knots.resize(1);
    EXPECT_THROW(validate(spec), UserError);
    spec = {};
    spec.radius_mm = -1.0;
    EXPECT_THROW(validate(spec), UserError);
}

TEST(HeartRows, FaceAndSideArePushedOutAndNothingElseIsTouched) {
    const HeartSpec spec;  // radius 18, height 40
    const std::vector<Vec3> particles = {
        {10.0, 0.0, -0.5},   // in the face
        {10.0, 0.0, 0.5},    // just over it
        {17.0, 0.0, -20.0},  // inside, near the side
        {0.0, 18.5, -10.0},  // beside, near
        {0.0, 19.5, 0.5},    // beside and above: free
        {0.0, 0.0, 5.0},     // far above
        {30.0, 0.0, -5.0},   // far beside
        {0.0, 0.0, -41.0},   // below
    };
    std::vector<CylinderRow> rows;
    find_rows(spec, Pose{}, particles, {}, 1.0, rows);
    ASSERT_EQ(rows.size(), 4u);
    EXPECT_EQ(rows[0].normal, Vec3(0, 0, 1));
    EXPECT_NEAR(rows[0].gap, -0.5, 1e-12);
    EXPECT_NEAR(rows[1].gap, 0.5, 1e-12);
    EXPECT_NEAR((rows[2].normal - Vec3::UnitX()).norm(), 0.0, 1e-12);
    EXPECT_NEAR(rows[2].gap, -1.0, 1e-12);
    EXPECT_NEAR((rows[3].normal - Vec3::UnitY()).norm(), 0.0, 1e-12);
    EXPECT_NEAR(rows[3].gap, 0.5, 1e-12);
    find_rows(spec, Pose{}, particles, std::vector<Index>{5, 0}, 1.0, rows);
    ASSERT_EQ(rows.size(), 1u);
    EXPECT_EQ(rows[0].particle, 0);
}

TEST(HeartRows, AParticleOnTheFaceIsCarriedUpAndLeftBehindOnTheWayDown) {
    const HeartSpec spec;
    HeartState state = initial_state(spec);
    std::vector<Vec3> x = {Vec3(5.0, 0.0, 0.0)};
    std::vector<CylinderRow> rows;
    double highest = 0.0;
    for (int i = 0; i < 2000; ++i) {
        advance(spec, state, 0.004);
        const Pose pose = cylinder_pose(spec, Pose{}, state.displacement_mm);
        find_rows(spec, pose, x, {}, 0.5, rows);
        for (const CylinderRow& row : rows) x[0] += std::max(0.0, -row.gap_at(x[0])) * row.normal;
        EXPECT_GE(x[0].z(), state.displacement_mm - 1e-12);
        EXPECT_GE(x[0].z(), highest);  // nothing pulls it back
        highest = x[0].z();
    }
    EXPECT_NEAR(highest, 11.6, 0.01);
}
