// A wire and a catheter side by side: the wire does not pass through the catheter.
#include <cstdio>
#include <limits>

#include "scene/temporary_folder.h"
#include "step/rig.h"

namespace cathlab {
namespace {

constexpr double mouth_mm = 25.0;  // so far both come out of one sheath

/// Least distance of the wire's axis from the catheter's, away from the mouth, less what both need.
double clearance(const RigRun& run) {
    const CatheterShape& lies = run.parts.catheter_route->shape;
    std::vector<RodSample> samples;
    run.parts.wire->samples(1.25, samples);
    double least = std::numeric_limits<double>::infinity();
    for (const RodSample& s : samples) {
        if ((s.position - run.parts.mount->mouth.position).norm() < mouth_mm) continue;
        for (std::size_t i = 0; i < lies.points.size(); ++i)
            least = std::min(least, (s.position - lies.points[i]).norm() - s.radius - run.parts.catheter->radius_mm());
    }
    return least;
}

TEST(WireBesideCatheter, OneWithoutALumenIsPassedOnItsOutside) {
    const TemporaryFolder folder;
    SceneSpec spec = rig_spec("fork");
    spec.catheter.device = folder.write("solid.toml", R"(
schema = 1
kind = "catheter"
name = "solid"
inner_diameter_mm = 0.0
tip_marker_length_mm = 0.0
tip_length_mm = 2.0
[[segments]]
name = "only"
length_mm = 20.0
max_bend_deg = 60.0
max_rate_deg_s = 60.0
)");
    spec.catheter.insertion_mm = 5.0;
    RigRun run(spec, "fork");
    double deepest = 0.0, least = std::numeric_limits<double>::infinity();
    for (int k = 0; k < 300; ++k) {
        Input input = push(k < 220 ? 25.0 : 0.0, k % 60 < 30 ? 0.0 : 1.0);
        input.rotate = 50.0;
        input.proximal_bend = 0.1 * k;
        run.step(input);
        ASSERT_TRUE(run.finite()) << k;
        EXPECT_EQ(run.channels.outside_count, 0.0) << k;
        deepest = std::max(deepest, run.channels.wire_penetration_mm);
        if (k > 100) least = std::min(least, clearance(run));
    }
    std::printf("the wire is %.3f mm in the catheter at most, %.3f mm in the wall\n", -least, deepest);
    EXPECT_GT(least, -0.1);
    EXPECT_LT(least, 0.1) << "they never touched";
    EXPECT_LT(deepest, 0.5);
}

}  // namespace
}  // namespace cathlab
