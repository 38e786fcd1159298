// A stiff wire that is pushed on in the aorta until its drive slips, at 5 N, is as long as its own axial stiffness
// says.
#include <algorithm>
#include <cstdio>
#include <filesystem>

#include "scene/temporary_folder.h"
#include "step/rig.h"

namespace cathlab {
namespace {

/// Openings of the joints over the material that each stands for, times the axial stiffness there: the force, mN, that
/// would open a joint of the catalogue's wire so far.  The largest of all joints.
double force_of_stretch_mn(const Rod& wire, double& stretch_of_shaft) {
    const auto section_at = [&](double arc) {
        double end = 0.0;
        for (const WireSection& s : wire.spec().sections)
            if (arc < (end += s.length_mm)) return &s;
        return &wire.spec().sections.back();
    };
    double most = 0.0, arc = 0.0;
    const double inside = wire.insertion_mm();
    for (std::size_t i = 0; i + 1 < wire.link_count(); ++i) {
        const double a = wire.link_length(i), b = wire.link_length(i + 1);
        arc += a;
        if (arc > inside) break;  // the sheath holds the rest
        const Pose front = wire.link_pose(i), back = wire.link_pose(i + 1);
        const Vec3 gap = (front.position - 0.5 * a * (front.orientation * Vec3::UnitZ())) -
                         (back.position + 0.5 * b * (back.orientation * Vec3::UnitZ()));
        const double stretch = gap.norm() / (0.5 * (a + b));
        const WireSection *before = section_at(arc - 0.5 * a), *behind = section_at(arc + 0.5 * b);
        if (before != behind) continue;  // a joint of two sections
        most = std::max(most, 1e3 * stretch * before->axial_stiffness_n);
        if (before == &wire.spec().sections.back()) stretch_of_shaft = std::max(stretch_of_shaft, stretch);
    }
    return most;
}

TEST(Stretch, OfAStiffWirePushedOnInTheAdultsAortaIsWhatItsAxialStiffnessGives) {
    const TemporaryFolder folder;
    const SceneSpec spec = load_scene(folder.write("pushed.toml", R"(
schema = 1
name = "pushed"
[anatomy]
file = "adult"
[wire]
enabled = true
device = "amplatz-super-stiff"
entry = "right_femoral"
insertion_mm = 760
)"),
                                      {}, CATHLAB_SOURCE_DIR);
    BuildOptions options;
    const auto program = std::filesystem::read_symlink("/proc/self/exe");
    options.cache_folder = (program.parent_path() / "models").string();
    RigRun run(build_world(spec, *build_models(spec, options), 1, 1));
    run.step({}, 50);  // laid along the middle of the vessels it finds its own way first
    double most = 0.0, shaft = 0.0, force_mn = 0.0, push_mn = 0.0;
    // 15 s: head-on at the wall the drive feeds slowly.  Half a second more under the full push.
    for (int k = 0, after = 0; k < 1000 && after < 25; ++k) {
        run.step(push(100.0));
        most = std::max(most, run.channels.wire_stretch_max);
        force_mn = std::max(force_mn, force_of_stretch_mn(*run.parts.wire, shaft));
        push_mn = std::max(push_mn, run.channels.wire_sheath_force_mn);
        if (push_mn > 4900.0) ++after;
    }
    std::printf("pushed by up to %.0f mN: largest stretch %.4f %%, of the shaft %.4f %%, as %.0f mN would\n", push_mn,
                100.0 * most, 100.0 * shaft, force_mn);
    EXPECT_GT(push_mn, 4900.0);
    EXPECT_LT(shaft, 2e-4);
    EXPECT_LT(most, 2.5e-4);  // of the ground-down front, whose axial stiffness is lower
    EXPECT_LT(force_mn, 1.1 * push_mn);
}

}  // namespace
}  // namespace cathlab
