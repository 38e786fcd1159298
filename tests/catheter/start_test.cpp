// A catheter that a run begins with deep in a curved vessel.
#include "catheter/start.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/units.h"

namespace cathlab {
namespace {

Rail arch(double radius_mm) {
    std::vector<Vec3> nodes;
    for (int i = 0; i <= 100; ++i) {
        const double a = 0.03 * i;
        nodes.push_back(radius_mm * Vec3(1.0 - std::cos(a), 0.0, std::sin(a)));
    }
    return build_rail({}, nodes, {});
}

TEST(CatheterStart, LiesAlongACurveWithinItsRanges) {
    const CatheterSpec spec;
    for (const double radius : {40.0, 60.0, 100.0}) {
        const Rail rail = arch(radius);
        CatheterState state = initial_state(spec, 110.0);
        state.rotation_rad = 0.7;
        lie_along(spec, state, rail);
        const CatheterShape lies = shape(spec, state, rail);
        double off = 0.0;
        for (std::size_t i = 0; i < lies.points.size(); ++i)
            off = std::max(off, (lies.points[i] - rail.point(lies.arc[i])).norm());
        EXPECT_LT(off, 40.0 / radius) << radius;
        for (std::size_t k = 0; k < 2; ++k)
            EXPECT_LE(state.bend_rad[k], spec.segments[k].max_bend_deg * units::deg * (1.0 + 1e-12));
    }
}

TEST(CatheterStart, IsStraightWhereTheVesselIs) {
    const CatheterSpec spec;
    const std::vector<Vec3> nodes{Vec3::Zero(), Vec3(0, 0, 60), Vec3(0, 0, 120), Vec3(0, 0, 180)};
    const Rail rail = build_rail({}, nodes, {});
    CatheterState state = initial_state(spec, 120.0);
    lie_along(spec, state, rail);
    for (const double bend : state.bend_rad) EXPECT_LT(bend, 1e-6);
}

}  // namespace
}  // namespace cathlab
