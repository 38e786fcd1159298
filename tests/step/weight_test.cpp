// A wire that lies on the wall of a lying tube: what the force channel reads is its weight.
#include <cmath>

#include "core/units.h"
#include "scene/temporary_folder.h"
#include "step/rig.h"

namespace cathlab {
namespace {

constexpr double density_kg_m3 = 6700.0, diameter_mm = 0.889, stiffness_n_mm2 = 2.0, insertion_mm = 110.0;
constexpr double tube_radius_mm = 5.0;  // of scenes/rigs/tube-anatomy.toml

SceneSpec lying_wire(const TemporaryFolder& folder, double gravity) {
    SceneSpec spec = rig_spec("tube_wire");
    spec.wire.device = folder.write("wire.toml", R"(
schema = 1
kind = "wire"
name = "even"
length_mm = 400.0
link_length_mm = 2.5
friction = 0.1
max_push_n = 5.0
max_speed_mm_s = 100.0
source = "made for this test"
[[sections]]
length_mm = 400.0
diameter_mm = 0.889
bending_stiffness_n_mm2 = 2.0
torsion_stiffness_n_mm2 = 1.5
axial_stiffness_n = 5000.0
density_kg_m3 = 6700.0
material = "stainless_steel"
)");
    spec.wire.insertion_mm = insertion_mm;
    spec.step.gravity_mm_s2 = {0.0, gravity, 0.0};
    return spec;
}

/// Mean of the channel over the last half second of four.
double reading(RigRun& run) {
    run.step({}, 175);
    double sum = 0.0;
    for (int k = 0; k < 25; ++k) {
        run.step({});
        sum += run.channels.wire_force_mn;
    }
    return sum / 25.0;
}

TEST(Weight, OfAWireThatLiesOnTheWallIsWhatTheForceChannelReads) {
    // A beam held level at its root, d above the floor on which the rest of it lies, touches down at a with
    // w a^4 = 72 EI d; there u = u' = u'' = 0.  The root carries 2/3 w a, the floor the rest.
    const TemporaryFolder folder;
    for (const double gravity : {50000.0, 100000.0}) {
        const double w = 1e-9 * density_kg_m3 * 0.25 * units::pi * diameter_mm * diameter_mm * gravity;  // mN/mm
        const double d = tube_radius_mm - 0.5 * diameter_mm;
        const double a = std::pow(72.0 * 1000.0 * stiffness_n_mm2 * d / w, 0.25);
        ASSERT_LT(a, 0.5 * insertion_mm);
        const double weight = w * (insertion_mm - 2.0 / 3.0 * a);
        RigRun run(lying_wire(folder, gravity), "tube_wire");
        const double read = reading(run);
        EXPECT_NEAR(read, weight, 0.01 * weight) << "gravity " << gravity;
        // Nothing else holds it: wall, sheath and weight sum to nothing.
        const Vec3 wall = run.parts.contacts->report(run.parts.wall_state->x).devices.front().force_mn;
        const Vec3 rest = wall + run.parts.wire->sheath_reaction_mn() + Vec3(0.0, w * insertion_mm, 0.0);
        EXPECT_LT(rest.norm(), 0.001 * w * insertion_mm);
        EXPECT_LT(run.channels.wire_penetration_mm, 0.1);
    }
}

TEST(Weight, WithoutGravityAWireInTheMiddleTouchesNothing) {
    const TemporaryFolder folder;
    RigRun run(lying_wire(folder, 0.0), "tube_wire");
    EXPECT_EQ(reading(run), 0.0);
}

}  // namespace
}  // namespace cathlab
