#include "beam/c_arm.h"

#include <gtest/gtest.h>

#include <cmath>

using namespace cathlab;

namespace {
const Vec3 isocentre(10.0, 20.0, 30.0);
Vec2 seen(double primary, double secondary, const Vec3& offset) {
    const CArmSpec spec;
    return project(spec, c_arm_pose(spec, isocentre, primary, secondary), isocentre + offset);
}
const double middle = 0.5 * 511.0;
}  // namespace

TEST(CArm, AtApThePatientsLeftIsOnTheImageRightAndTheHeadAbove) {
    EXPECT_GT(seen(0, 0, {10, 0, 0}).x(), middle + 1.0);
    EXPECT_NEAR(seen(0, 0, {10, 0, 0}).y(), middle, 1e-9);
    EXPECT_LT(seen(0, 0, {0, 0, 10}).y(), middle - 1.0);
    EXPECT_NEAR(seen(0, 0, Vec3::Zero()).x(), middle, 1e-9);
    const CArmSpec spec;
    EXPECT_LT(c_arm_pose(spec, isocentre, 0, 0).detector.y(), isocentre.y());  // in front of the chest
    EXPECT_GT(c_arm_pose(spec, isocentre, 0, 0).source.y(), isocentre.y());    // under the table
}

TEST(CArm, InLaoTheDetectorStandsAtThePatientsLeftAndTheSpineAtTheImageRight) {
    const CArmSpec spec;
    const Vec3 spine(0.0, 50.0, 0.0);
    EXPECT_GT(c_arm_pose(spec, isocentre, 45, 0).detector.x(), isocentre.x() + 100.0);
    EXPECT_GT(seen(45, 0, spine).x(), middle + 10.0);
    EXPECT_LT(c_arm_pose(spec, isocentre, -30, 0).detector.x(), isocentre.x() - 100.0);
    EXPECT_LT(seen(-30, 0, spine).x(), middle - 10.0);
    EXPECT_NEAR((c_arm_pose(spec, isocentre, 90, 0).forward - Vec3::UnitX()).norm(), 0.0, 1e-12);  // left lateral
}

TEST(CArm, CranialMovesTheDetectorToTheHead) {
    const CArmSpec spec;
    EXPECT_GT(c_arm_pose(spec, isocentre, 0, 30).detector.z(), isocentre.z() + 100.0);
    EXPECT_LT(c_arm_pose(spec, isocentre, 20, -30).detector.z(), isocentre.z() - 100.0);
    // What lies in front (anterior) moves down the image when the detector moves up.
    EXPECT_GT(seen(0, 30, {0, -50, 0}).y(), middle + 10.0);
}

TEST(CArm, AFrameIsRightHandedAtAnyAngle) {
    const CArmSpec spec;
    for (double a = -180.0; a <= 180.0; a += 17.0)
        for (double b = -90.0; b <= 90.0; b += 15.0) {
            const CArmPose pose = c_arm_pose(spec, isocentre, a, b);
            EXPECT_NEAR(pose.right.dot(pose.down), 0.0, 1e-12);
            EXPECT_NEAR(pose.forward.dot(pose.right), 0.0, 1e-12);
            EXPECT_NEAR((pose.right.cross(-pose.down) - pose.forward).norm(), 0.0,
                        1e-12);  // right x up = towards the viewer
            EXPECT_NEAR((pose.detector - pose.source).norm(), spec.sid_mm, 1e-9);
            EXPECT_NEAR((pose.source - isocentre).norm(), spec.sod_mm, 1e-9);
        }
}

TEST(CArm, MagnificationIsSidOverSod) {
    const CArmSpec spec;
    const double pixels = (seen(33, 12, c_arm_pose(spec, isocentre, 33, 12).right * 20.0).x() - middle);
    EXPECT_NEAR(pixels, 20.0 * spec.sid_mm / spec.sod_mm / spec.pixel_mm(), 0.1);
    EXPECT_NEAR(pixels, 20.0 * spec.sid_mm / spec.sod_mm / spec.pixel_mm(), 1e-8);
}

TEST(CArm, APointLiesOnTheRayToItsPixel) {
    const CArmSpec spec;
    const CArmPose pose = c_arm_pose(spec, isocentre, -25, 18);
    const Vec3 p = isocentre + Vec3(13.0, -22.0, 41.0);
    const Vec3 q = pixel_on_detector(spec, pose, project(spec, pose, p));
    EXPECT_NEAR((p - pose.source).normalized().cross((q - pose.source).normalized()).norm(), 0.0, 1e-12);
    EXPECT_TRUE(std::isnan(project(spec, pose, pose.source - pose.forward).x()));
}

TEST(CArm, GeometryThatCannotBeIsRefused) {
    CArmSpec spec;
    EXPECT_NO_THROW(validate(spec));
    spec.sod_mm = 1100.0;
    EXPECT_THROW(validate(spec), UserError);
    spec = {};
    spec.field_mm = 0.0;
    EXPECT_THROW(validate(spec), UserError);
    spec = {};
    spec.columns = 0;
    EXPECT_THROW(validate(spec), UserError);
}
