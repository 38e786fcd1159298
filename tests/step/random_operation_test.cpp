// Full-speed random operation of both devices: nothing leaves the lumen and nothing bursts, whatever the hands do.
//
// CATHLAB_RANDOM_SECONDS lengthens each run, CATHLAB_RANDOM_SEEDS makes more of them, CATHLAB_RANDOM_FIRST_SEED leaves
// the first ones out (docs/validation.md).
#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <sstream>

#include "core/random.h"
#include "scene/temporary_folder.h"
#include "step/inside_account.h"
#include "step/rig.h"

namespace cathlab {
namespace {

constexpr double limit_mm = 0.3, coronary_limit_mm = 0.2;
// A long run says where it stands.
constexpr int steps_a_line = 3000;

/// A positive number of the environment.
double from_environment(const char* name, double otherwise) {
    const char* text = std::getenv(name);
    if (!text) return otherwise;
    char* end = nullptr;
    const double number = std::strtod(text, &end);
    if (end != text && *end == '\0' && number > 0.0 && number < 1e6) return number;
    ADD_FAILURE() << name << ": found '" << text << "', allowed are numbers above 0";
    return otherwise;
}

/// Seconds of simulated time of a run.
double run_seconds(double otherwise) {
    return from_environment("CATHLAB_RANDOM_SECONDS", otherwise);
}

/// New commands every 0.7 s, mostly at full speed and mostly inward: any device, turn, bend and direction.
Input random_hands(std::uint64_t seed, double time_s) {
    const auto command = static_cast<std::uint64_t>(time_s / 0.7);
    const auto draw = [&](std::uint64_t i) { return 2.0 * random_uniform(seed, RandomStream::test, command, i) - 1.0; };
    Input input;
    input.device = draw(0) > 0.2 ? 1.0 : 0.0;
    input.advance = draw(1) > -0.3 ? 100.0 * (draw(9) > 0.0 ? 1.0 : draw(1)) : -100.0;
    input.rotate = 360.0 * draw(2);
    input.proximal_bend = 60.0 * std::fabs(draw(3));
    input.distal_bend = 140.0 * std::fabs(draw(4));
    input.proximal_direction = 180.0 * draw(5);
    input.distal_direction = 180.0 * draw(6);
    return input;
}

std::string place(const Parts& parts, const DevicePoint& point, double time_s) {
    std::ostringstream text;
    text << "at " << time_s << " s, " << (point.device == wire_device ? "wire" : "catheter") << ", " << point.arc_mm
         << " mm from its tip, at " << point.position.transpose();
    const auto wall = parts.contacts->wall_rows();
    for (std::size_t r = 0; r < wall.size(); ++r)
        if (wall[r].device == point.device && std::fabs(wall[r].arc_mm - point.arc_mm) < 0.7)
            text << " [row: " << parts.contacts->rows()[r].multiplier << " mN, gap " << parts.contacts->rows()[r].gap
                 << " mm]";
    return text.str();
}

/// Operates both devices and looks after every step.
void operate_at_random(const SceneSpec& spec, const SceneModels& models, std::uint64_t seed, double seconds) {
    RigRun run(build_world(spec, models, seed, 1));
    LumenSurfaceState surface;
    double deepest = 0.0, in_coronaries = 0.0, energy_uj = 0.0;
    std::string where = "nowhere";
    int too_deep = 0, outside = 0;
    double imbalance = 0.0, touched = 0.0;
    const double dt = run.parts.settings->dt;
    const auto steps = static_cast<int>(std::lround(seconds / dt));
    for (int k = 0; k < steps; ++k) {
        run.step(random_hands(seed, k * dt));
        ASSERT_TRUE(run.finite()) << "at " << run.world->time_s << " s";
        const InsideAccount account = inside_account(run.parts, surface);
        if (account.deepest_mm > deepest) {
            deepest = account.deepest_mm;
            where = place(run.parts, account.deepest, run.world->time_s);
        }
        in_coronaries = std::max(in_coronaries, account.deepest_in_coronaries_mm);
        energy_uj = std::max(energy_uj, run.channels.wall_kinetic_energy_uj + run.parts.wire->energy_uj());
        too_deep += account.deepest_mm >= limit_mm ? 1 : 0;
        outside += account.outside > 0 ? 1 : 0;
        imbalance = std::max(imbalance, run.channels.momentum_residual);
        touched = std::max({touched, run.channels.wire_force_mn, run.channels.catheter_force_mn});
        if ((k + 1) % steps_a_line == 0 && k + 1 < steps)
            std::cout << "seed " << seed << ", " << run.world->time_s << " s: deepest so far " << deepest << " mm "
                      << where << "; deeper than allowed in " << too_deep << " steps, outside in " << outside
                      << std::endl;
    }
    EXPECT_LT(in_coronaries, coronary_limit_mm) << where;
    EXPECT_LT(deepest, limit_mm) << where << "; deeper than allowed in " << too_deep << " steps";
    EXPECT_EQ(outside, 0) << "steps with a part of a device beyond the wall";
    EXPECT_LT(imbalance, 1e-6);
    EXPECT_GT(touched, 1.0) << "nothing was touched";
    std::cout << "seed " << seed << ", " << seconds << " s: deepest " << deepest << " mm " << where
              << ", in the coronaries " << in_coronaries << " mm; outside in " << outside << " steps; energy up to "
              << energy_uj << " uJ; imbalance of forces " << imbalance << "; largest force " << touched << " mN"
              << std::endl;
}

constexpr std::uint64_t seeds = 5;

/// Beside the test program: to build these anatomies takes longer than to operate in them.
std::string models_folder() {
    std::error_code error;
    const auto program = std::filesystem::read_symlink("/proc/self/exe", error);
    return error ? "" : (program.parent_path() / "models").string();
}

void operate_with_every_seed(const SceneSpec& spec, double seconds, std::uint64_t last = seeds) {
    BuildOptions options;
    options.cache_folder = models_folder();
    const auto models = build_models(spec, options);
    last = static_cast<std::uint64_t>(from_environment("CATHLAB_RANDOM_SEEDS", static_cast<double>(last)));
    const auto first = static_cast<std::uint64_t>(from_environment("CATHLAB_RANDOM_FIRST_SEED", 1.0));
    for (std::uint64_t seed = first; seed <= last; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        operate_at_random(spec, *models, seed, seconds);
    }
}

SceneSpec adult() {
    const TemporaryFolder folder;
    return load_scene(folder.write("adult.toml", R"(
schema = 1
name = "full-speed"
[anatomy]
file = "adult"
[wire]
enabled = true
device = "amplatz-super-stiff"
entry = "right_femoral"
insertion_mm = 60
[catheter]
enabled = true
device = "magellan-6f"
entry = "right_femoral"
insertion_mm = 20
[heart]
enabled = true
[effects.respiration]
)"),
                      {}, CATHLAB_SOURCE_DIR);
}

TEST(RandomFullSpeedOperation, NeverLeavesTheAdultsVessels) {
    operate_with_every_seed(adult(), run_seconds(6.0));
}

TEST(RandomFullSpeedOperation, NeverLeavesTheAdultsVesselsOfElasticWall) {
    SceneSpec spec = adult();
    spec.wall.form = "elastic";
    operate_with_every_seed(spec, run_seconds(3.0), 2);
}

TEST(RandomFullSpeedOperation, NeverLeavesThePatientsVessels) {
    const std::string mesh = std::string(CATHLAB_SHARED_DATA) + "/anatomy/arch-and-carotids.obj";
    if (!std::filesystem::exists(mesh)) GTEST_SKIP() << mesh << " is not there";
    const std::string scene = std::string(CATHLAB_SOURCE_DIR) + "/scenes/imported.toml";
    operate_with_every_seed(load_scene(scene, {}, CATHLAB_SOURCE_DIR), run_seconds(3.0));
}

// Where the left carotid leaves the arch, facets are larger than a tip: a tent of them folded over the catheter's (1.35
// mm at 13 s) before neighbours pushed it out one after the other.
TEST(RandomFullSpeedOperation, IsNotFoldedOverByACoarseBranch) {
    const std::string mesh = std::string(CATHLAB_SHARED_DATA) + "/anatomy/arch-and-carotids.obj";
    if (!std::filesystem::exists(mesh)) GTEST_SKIP() << mesh << " is not there";
    const SceneSpec spec =
        load_scene(std::string(CATHLAB_SOURCE_DIR) + "/scenes/imported.toml", {}, CATHLAB_SOURCE_DIR);
    BuildOptions options;
    options.cache_folder = models_folder();
    operate_at_random(spec, *build_models(spec, options), 9, run_seconds(13.5));
}

// Bent in a way of its own, the catheter is pushed on into the root while the heart closes it: presses at which a fold
// of the wall once turned round over the tip and was driven along the shaft (up to 124 mm of wall, 77 N).
TEST(PressedCatheter, DoesNotThrowTheBeatingRoot) {
    SceneSpec spec = load_scene(std::string(CATHLAB_SOURCE_DIR) + "/scenes/tasks/c.toml", {}, CATHLAB_SOURCE_DIR);
    spec.catheter.insertion_mm = 725.0;
    BuildOptions options;
    options.cache_folder = models_folder();
    const auto models = build_models(spec, options);
    constexpr double root_swing_mm = 11.6;  // of the heart and the breath alone
    for (const std::uint64_t press : {39, 40, 47}) {
        SCOPED_TRACE(press);
        RigRun run(build_world(spec, *models, spec.seed, 1));
        const auto draw = [&](std::uint64_t i) { return random_uniform(7, RandomStream::test, press, i); };
        Input input;
        input.device = 1.0;
        input.proximal_bend = 50.0 * draw(0);
        input.distal_bend = 140.0 * draw(1);
        input.proximal_direction = 360.0 * draw(2) - 180.0;
        input.distal_direction = std::remainder(input.proximal_direction + 60.0 * draw(3) - 30.0, 360.0);
        double wall_mm = 0.0, force_mn = 0.0;
        for (int k = 0; k < 200; ++k) {
            input.advance = k < 40 ? 0.0 : 20.0;
            run.step(input);
            wall_mm = std::max(wall_mm, run.channels.wall_displacement_max_mm);
            force_mn = std::max(force_mn, run.channels.catheter_force_mn);
        }
        EXPECT_LT(wall_mm, root_swing_mm + 2.0);
        EXPECT_LT(force_mn, 3000.0);
        EXPECT_GT(force_mn, 300.0) << "nothing was pressed";
    }
}

TEST(InsideAccount, ReadsTheDepthByWhichATubeIsShifted) {
    RigRun run("tube_wire");
    LumenSurfaceState surface;
    const InsideAccount before = inside_account(run.parts, surface);
    EXPECT_EQ(before.deepest_mm, 0.0);
    EXPECT_GT(before.points, 50U);
    for (const double shift : {5.0, 7.0}) {
        RigRun shifted("tube_wire");
        for (Vec3& x : shifted.parts.wall_state->x) x.x() += shift;
        const InsideAccount after = inside_account(shifted.parts, surface);
        // The wire lies in the axis of a tube of 5 mm radius.
        EXPECT_NEAR(after.deepest_mm, shift - 5.0 + after.deepest.radius, 0.3);
        EXPECT_EQ(after.outside > 0, shift > 6.0);
    }
}

}  // namespace
}  // namespace cathlab
