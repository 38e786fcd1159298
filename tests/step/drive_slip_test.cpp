// Rollers hold a wire no harder than they can: what a catheter around it pushes beyond that slips through them.
#include <gtest/gtest.h>

#include <cmath>

#include "core/units.h"
#include "rod/rod_fixture.h"
#include "step/devices.h"

namespace cathlab {
namespace {

/// A short stiff wire whose tip is pressed back along its axis.
double slip_under(double force_n, double& held_n) {
    WireSpec spec = test::amplatz(5.0);
    spec.max_push_n = 5.0;
    Rod rod(spec, {}, 30.0);
    test::settle(rod, 0, Vec3(0.0, 0.0, -force_n * units::newton), 0.05, 100);
    held_n = rod.sheath_force_mn() / units::newton;
    return drive_slip(rod, 0.005);
}

TEST(DriveSlip, IsNothingUpToWhatTheRollersHoldAndThenGrowsWithTheExcess) {
    double held = 0.0;
    EXPECT_EQ(slip_under(3.0, held), 0.0);
    EXPECT_NEAR(held, 3.0, 0.05);
    EXPECT_EQ(slip_under(-3.0, held), 0.0);
    // Half as much again: half of 40 mm/s, out of the patient.
    const double out = slip_under(7.5, held);
    EXPECT_NEAR(held, 7.5, 0.1);
    EXPECT_NEAR(out, -0.1, 0.005);
    EXPECT_NEAR(slip_under(-7.5, held), 0.1, 0.005);  // pulled: into it
    EXPECT_NEAR(slip_under(30.0, held), -0.2, 1e-9);  // never faster
}

}  // namespace
}  // namespace cathlab
