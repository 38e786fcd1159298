// The chain against the closed forms of the straight beam.
#include <gtest/gtest.h>

#include <cmath>

#include "rod_fixture.h"

namespace cathlab {
namespace {

using test::settle;

double drop_error(const WireSpec& spec, double insertion, double relative_drop) {
    Rod rod(spec, {}, insertion);
    const double arm = insertion - 0.5 * rod.link_length(0);  // the force acts on the first link's centre
    const double ei = spec.sections[0].bending_stiffness_n_mm2 * 1000.0;
    const double force = relative_drop * arm * 3.0 * ei / (arm * arm * arm);
    const Vec3 before = rod.link_pose(0).position;
    settle(rod, 0, Vec3(force, 0.0, 0.0));
    const double drop = rod.link_pose(0).position.x() - before.x();
    return drop / (relative_drop * arm) - 1.0;
}

TEST(Beam, ACantileverDropsAsTheBeamEquationSays) {
    for (const double insertion : {60.0, 151.0, 300.7}) {
        EXPECT_NEAR(drop_error(test::bmw(), insertion, 0.01), 0.0, 0.01) << "thin wire, " << insertion << " mm";
        EXPECT_NEAR(drop_error(test::amplatz(), insertion, 0.01), 0.0, 0.01) << "stiff wire, " << insertion << " mm";
    }
}

TEST(Beam, HalvingTheLinksQuartersTheError) {
    const double coarse = std::fabs(drop_error(test::amplatz(12.0), 144.0, 0.001));
    const double fine = std::fabs(drop_error(test::amplatz(6.0), 144.0, 0.001));
    const double finest = std::fabs(drop_error(test::amplatz(3.0), 144.0, 0.001));
    EXPECT_LT(fine, 0.35 * coarse);
    EXPECT_LT(finest, 0.35 * fine);
    RecordProperty("coarse", std::to_string(coarse));
    std::printf("errors %g %g %g\n", coarse, fine, finest);
}

TEST(Beam, TheWireStretchesByItsAxialStiffness) {
    const WireSpec spec = test::bmw();
    Rod rod(spec, {}, 300.0);
    const double before = rod.link_pose(0).position.z();
    const double force = 5000.0;
    settle(rod, 0, Vec3(0.0, 0.0, force));
    const double expected = force * (300.0 - 0.5 * rod.link_length(0)) / (spec.sections[0].axial_stiffness_n * 1000.0);
    EXPECT_NEAR(rod.link_pose(0).position.z() - before, expected, 0.01 * expected);
    EXPECT_LT(rod.max_stretch(), 1e-3);
    EXPECT_NEAR(rod.sheath_force_mn(), -force, 1e-6 * force);
}

}  // namespace
}  // namespace cathlab
