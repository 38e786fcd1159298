// docs/adding-an-effect.md as it is told there: its file and its line make a program (tests/CMakeLists.txt) that knows
// one effect more.  The simulator runs it and the tracer names it.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <sstream>

#include "core/random.h"
#include "explain/folder.h"
#include "explain/tracer.h"
#include "scene/temporary_folder.h"
#include "step/rig.h"

namespace cathlab {
namespace {

constexpr double degree = 3.14159265358979323846 / 180.0;

TEST(AddedEffect, IsKnownByItsNameAndDoesWhatItSays) {
    const EffectInfo* info = find_effect("stiff-start");
    ASSERT_NE(info, nullptr);
    Actuation act;
    act.segments.resize(2);
    act.segments[0].bend_rad = Vec2(10.0 * degree, 0.0);
    act.segments[1].bend_rad = Vec2(0.0, 2.0 * degree);
    info->make(std::vector<double>{3.0})->actuation({}, act);
    EXPECT_NEAR(act.segments[0].bend_rad.x() / degree, 7.0, 1e-12);
    EXPECT_EQ(act.segments[1].bend_rad, Vec2::Zero());
}

TEST(AddedEffect, RunsInTheSimulatorWhereAnOverlaySwitchesItOn) {
    TemporaryFolder folder;
    SceneSpec spec =
        rig_spec("fork", {folder.write("o.toml", "[effects.stiff_start]\nenabled = true\nthreshold_deg = 4.0\n")});
    spec.heart.enabled = spec.wire.enabled = false;
    spec.catheter.enabled = true;
    RigRun run(spec, "fork");
    Input input;
    input.device = 1.0;
    input.proximal_bend = 10.0;
    run.step(input, 25);
    EXPECT_NEAR(run.channels.catheter_proximal_bend_deg, 6.0, 1e-6);
}

TEST(AddedEffect, IsNamedByTheTracerWhereItActs) {
    const double lost = 6.0, p = 25.0, link = 4.0, d = 30.0, tip = 2.0;
    const auto bends = [&](double commanded) {
        return std::fabs(commanded) > lost ? commanded - std::copysign(lost, commanded) : 0.0;
    };
    std::ostringstream csv;
    csv.precision(9);
    csv << "run,t_s,insertion_mm,rotation_deg,proximal_bend_deg,distal_bend_deg,tip_x_mm,tip_y_mm,tip_z_mm\n";
    for (int i = 0; i < 240; ++i) {
        const int run = i / 120;
        const double t = 0.5 * (i % 120), a = 40.0 * std::sin(0.31 * t + run),
                     b = 60.0 * std::sin(0.17 * t + 2.0 * run);
        // In the plane: many short straight pieces.
        double x = 0.0, z = 0.0, angle = 0.0;
        const auto along = [&](double length, double turn) {
            constexpr int pieces = 400;
            for (int k = 0; k < pieces; ++k) {
                angle += 0.5 * turn / pieces;
                x += length / pieces * std::sin(angle);
                z += length / pieces * std::cos(angle);
                angle += 0.5 * turn / pieces;
            }
        };
        along(p, bends(a) * degree);
        along(link, 0.0);
        along(d, bends(b) * degree);
        along(tip, 0.0);
        const auto noise = [&](std::uint64_t axis) {
            return 0.05 * random_normal(7, RandomStream::test, static_cast<std::uint64_t>(i), axis);
        };
        csv << run << "," << t << ",5,0," << a << "," << b << "," << x + noise(0) << "," << noise(1) << ","
            << 5.0 + z + noise(2) << "\n";
    }
    const explain_test::Folder folder(
        "format = 1\ntitle = \"t\"\nsource = \"s\"\nlicense = \"l\"\ndeclared_effects = []\nsensor_noise = 0.05\n"
        "kind = \"catheter-tip\"\n[setup]\nproximal_length_mm = 25\nmiddle_length_mm = 4\ndistal_length_mm = 30\n"
        "tip_length_mm = 2\nbase_position_mm = [0, 0, 0]\nbase_axis = [0, 0, 1]\nbend_plane_axis = [1, 0, 0]\n",
        csv.str());
    ExplainOptions options;
    options.threads = 2;
    const Explanation found = explain(read_dataset(folder.path()), options);
    ASSERT_EQ(found.effects.size(), 1U);
    EXPECT_EQ(found.effects[0].name, "stiff-start");
    EXPECT_NEAR(found.effects[0].parameters[0].second, lost, 0.1);
    EXPECT_EQ(found.verdict, Verdict::explained);
    EXPECT_NE(found.overlay.find("[effects.stiff_start]"), std::string::npos);
}

}  // namespace
}  // namespace cathlab
