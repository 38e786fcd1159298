// Contacts beside finite elements, where those are; and figures that are known.
#include "calibrate/contact_comparison.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/errors.h"
#include "softbody/held_tube.h"

namespace cathlab {
namespace {

PushRig rig() {
    return held_tube(40.0);
}

/// What the rig itself does, as if it had been measured.
MeasuredPush own_push(double z) {
    MeasuredPush m;
    m.name = "at " + std::to_string(z);
    for (const double d : {0.0, 0.5, 1.0, 0.5}) m.push.ball_mm.emplace_back(9.5 + d, 0.0, z);
    m.push.marker_mm = Vec3(13.5, 0.0, z + 4.0);
    const PushResult result = PushedWall(rig()).push(m.push);
    m.marker_mm = result.marker_mm;
    m.force_mn = result.force_mn;
    return m;
}

TEST(ContactComparison, OfTheWallWithItselfMissesNothingOnAnyThreads) {
    const std::vector<MeasuredPush> pushes{own_push(15.0), own_push(20.0)};
    for (const int threads : {1, 2}) {
        const ContactComparison c = compare_contacts(rig(), pushes, Workers(threads));
        EXPECT_EQ(c.displacement.rmse, 0.0);
        EXPECT_EQ(c.worst_force, 0.0);
        EXPECT_NEAR(c.pearson, 1.0, 1e-12);
        EXPECT_EQ(c.moved_mm.size(), 8U);
    }
}

TEST(ContactComparison, AStifferWallIsReadFromTheForceAndAShiftFromThePlace) {
    MeasuredPush m = own_push(20.0);
    for (double& f : m.force_mn) f *= 0.5;
    for (Vec3& p : m.marker_mm) p += Vec3(0.0, 0.3, 0.0);
    const ContactComparison c = compare_contacts(rig(), {m}, Workers());
    EXPECT_NEAR(c.worst_force, 1.0, 1e-9);
    EXPECT_NEAR(c.place_rmse_mm, 0.3, 1e-9);
    m.force_mn.clear();
    EXPECT_TRUE(std::isnan(compare_contacts(rig(), {m}, Workers()).worst_force));
}

TEST(ContactComparison, WithoutContactsOrOfUnequalColumnsItIsTheUsersError) {
    EXPECT_THROW(compare_contacts(rig(), {}, Workers()), UserError);
    MeasuredPush m = own_push(20.0);
    m.marker_mm.pop_back();
    EXPECT_THROW(compare_contacts(rig(), {m}, Workers()), UserError);
    EXPECT_THROW(compare_contacts(rig(), {own_push(20.0)}, Workers(), [] { return false; }), UserError);
}

}  // namespace
}  // namespace cathlab
