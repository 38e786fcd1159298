// The effect tip_compliance: the steerable tip yields to what presses on it.
#include "step/tip_yield.h"

#include <cstdio>

#include "core/units.h"
#include "step/rig.h"

namespace cathlab {
namespace {

SceneSpec yielding(double mm_per_n) {
    SceneSpec spec = rig_spec("tube_catheter");
    if (mm_per_n > 0.0) enable(spec, "tip_compliance", {{"compliance_mm_per_n", mm_per_n}});
    return spec;
}

/// Bends the tip against the side of the tube and holds it there.
RigRun pressed(double mm_per_n) {
    RigRun run(yielding(mm_per_n), "tube_catheter");
    run.step(push(50.0, 1.0), 60);
    Input bend;
    bend.device = 1.0;
    bend.distal_bend = 20.0;
    run.step(bend, 150);
    return run;
}

/// Sum of share times force over the catheter's rows, mN.
Vec3 tip_force(const RigRun& run) {
    Vec3 sum = Vec3::Zero();
    const auto rows = run.parts.contacts->rows();
    for (std::size_t i = 0; i < rows.size(); ++i)
        sum += tip_share(*run.parts.catheter, run.parts.contacts->wall_rows()[i].arc_mm) *
               (rows[i].multiplier * rows[i].normal + rows[i].tangent_force);
    return sum;
}

TEST(TipYield, AtRestTheTipStandsOffItsDriveByComplianceTimesForce) {
    const RigRun rigid = pressed(0.0);
    const double force = tip_force(rigid).norm();
    EXPECT_GT(force, 5.0);
    EXPECT_TRUE(rigid.parts.catheter_route->driven.points.empty());
    double last = force;
    for (const double compliance : {2.0, 20.0}) {
        RigRun run = pressed(compliance);
        const CatheterRoute& route = *run.parts.catheter_route;
        const Vec3 way = route.shape.tip.position - route.driven.tip.position;
        const Vec3 expected = compliance / units::newton * tip_force(run);
        std::printf("%4.0f mm/N: %.4f mm under %.2f mN (rigid: %.2f mN)\n", compliance, way.norm(),
                    tip_force(run).norm(), force);
        EXPECT_LT((way - expected).norm(), 0.01 * expected.norm());
        EXPECT_LT(tip_force(run).norm(), last);
        last = tip_force(run).norm();
        EXPECT_EQ(run.channels.outside_count, 0.0);
        EXPECT_LT(run.channels.momentum_residual, 1e-9);
    }
}

TEST(TipYield, LetGoItGoesBackToWhereItsDriveHasIt) {
    RigRun run = pressed(20.0);
    Input straight;
    straight.device = 1.0;
    run.step(straight, 100);
    EXPECT_LT(run.parts.catheter_route->yielded.norm(), 1e-9);
    EXPECT_EQ(run.parts.catheter_route->shape.points.size(),
              shape(*run.parts.catheter, *run.parts.catheter_state, run.parts.catheter_route->laid).points.size());
}

TEST(TipYield, TheSharesAreThoseOfACantilever) {
    CatheterSpec spec;
    EXPECT_DOUBLE_EQ(tip_share(spec, 0.0), 1.0);
    EXPECT_NEAR(tip_share(spec, 0.5 * spec.steerable_length_mm()), 5.0 / 16.0, 1e-12);
    EXPECT_EQ(tip_share(spec, spec.steerable_length_mm()), 0.0);
    EXPECT_EQ(tip_share(spec, 500.0), 0.0);
}

TEST(TipYield, OperatedAtRandomItStaysInsideAndFinite) {
    for (const double compliance : {5.0, 50.0}) {
        SceneSpec spec = rig_spec("fork");
        enable(spec, "tip_compliance", {{"compliance_mm_per_n", compliance}});
        RigRun run(spec, "fork");
        double deepest = 0.0;
        for (int k = 0; k < 400; ++k) {
            run.step(busy_hands(2 * k));
            ASSERT_TRUE(run.finite()) << k;
            EXPECT_EQ(run.channels.outside_count, 0.0) << k;
            deepest = std::max(deepest, run.channels.catheter_penetration_mm);
        }
        std::printf("%.0f mm/N: deepest %.3f mm\n", compliance, deepest);
        EXPECT_LT(deepest, 0.5);
    }
}

}  // namespace
}  // namespace cathlab
