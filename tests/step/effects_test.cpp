// Every hook of an effect, through the whole step.
#include <algorithm>
#include <cmath>

#include "scene/temporary_folder.h"
#include "step/support_force.h"

namespace cathlab {
namespace {

TEST(InputHook, AGainOfOneHalfHalvesWhatTheWireGains) {
    SceneSpec spec = rig_spec("tube_wire");
    RigRun plain(spec, "tube_wire");
    enable(spec, "test_input", {{"gain", 0.5}});
    RigRun halved(spec, "tube_wire");
    plain.step(push(20.0), 50);
    halved.step(push(20.0), 50);
    EXPECT_NEAR(plain.channels.wire_insertion_mm, 100.0, 1e-9);
    EXPECT_NEAR(halved.channels.wire_insertion_mm, 90.0, 1e-9);
}

TEST(DriveHook, SupportsStandWhereTheEffectPutsThemAndTheTubeFollows) {
    SceneSpec spec = rig_spec("tube_wire");
    enable(spec, "test_drive", {{"offset_mm", 2.0}});
    RigRun run(spec, "tube_wire");
    run.step({}, 100);
    const SoftBodyModel& wall = *run.parts.wall;
    for (std::size_t i = 0; i < wall.size(); ++i) {
        const Vec3 u = run.parts.wall_state->x[i] - wall.rest[i];
        if (wall.fixed[i])
            EXPECT_LT((u - Vec3(0, 0, 2.0)).norm(), 1e-12);
        else
            EXPECT_LT((u - Vec3(0, 0, 2.0)).norm(), 0.1);
    }
    EXPECT_DOUBLE_EQ(run.channels.support_displacement_mm, 2.0);
}

TEST(DriveHook, RespirationMovesTheForkByItsAmplitudeAndBack) {
    SceneSpec spec = rig_spec("fork");
    spec.heart.enabled = spec.wire.enabled = spec.catheter.enabled = false;
    RigRun run(spec, "fork");
    double largest = 0.0;
    for (int k = 0; k < 200; ++k) {
        run.step({});
        largest = std::max(largest, run.channels.support_displacement_mm);
        EXPECT_LE(run.channels.wall_displacement_max_mm, 4.4) << k;
    }
    EXPECT_NEAR(largest, 4.0, 1e-9);
    EXPECT_NEAR(run.channels.support_displacement_mm, 0.0, 1e-9) << "after one breath of 4 s";
}

TEST(MeasureHook, TheSensorIsWrongAndThePhysicsIsNot) {
    SceneSpec spec = rig_spec("tube_wire");
    RigRun plain(spec, "tube_wire");
    enable(spec, "test_measure", {{"offset_mm", 7.5}});
    RigRun offset(spec, "tube_wire");
    for (int k = 0; k < 30; ++k) {
        plain.step(busy_hands(k));
        offset.step(busy_hands(k));
        EXPECT_EQ(offset.channels.wire_insertion_mm, offset.parts.wire->insertion_mm() + 7.5);
    }
    for (const char* entity : {"vessel", "wire"}) EXPECT_EQ(plain.hash_of(entity), offset.hash_of(entity)) << entity;
}

// A uniform acceleration a of the wall, along the tube: a weight of sum m a.
constexpr double acceleration = 20000.0;  // mm/s2

SceneSpec weighed_tube() {
    SceneSpec spec = rig_spec("tube_wire");
    spec.wire.enabled = false;
    enable(spec, "test_force", {{"acceleration_mm_s2", acceleration}});
    return spec;
}

TEST(ForceHook, TheWeightOfTheWallIsWhatItsSupportsCarry) {
    RigRun run(weighed_tube(), "tube_wire");
    run.step({}, 150);
    const SoftBodyModel& wall = *run.parts.wall;
    double weight = 0.0;
    for (std::size_t i = 0; i < wall.size(); ++i)
        if (!wall.fixed[i]) weight += wall.mass[i] * acceleration;
    const double carried = force_on_supports(run).z();
    EXPECT_GT(run.channels.wall_displacement_max_mm, 0.01);
    EXPECT_NEAR(carried, weight, 0.01 * weight);
}

TEST(MaterialHook, TwiceTheStiffnessGivesWayHalfAsFar) {
    SceneSpec spec = weighed_tube();
    spec.wall.surrounding_kpa_per_mm = 0.0;  // nothing but the wall carries it
    spec.wall.damping_per_s = 50.0;
    const auto models = build_models(spec, {});
    RigRun soft(build_world(spec, *models, 1, 1));
    enable(spec, "test_material", {{"factor", 2.0}});
    RigRun stiff(build_world(spec, *models, 1, 1));
    soft.step({}, 200);
    stiff.step({}, 200);
    EXPECT_NEAR(soft.channels.wall_displacement_max_mm / stiff.channels.wall_displacement_max_mm, 2.0, 0.04);
}

TEST(ConstraintHook, StiffSpringsHoldEveryParticle) {
    constexpr double stiffness = 1000.0;  // mN/mm, a thousand times what the load needs
    SceneSpec spec = weighed_tube();
    RigRun loose(spec, "tube_wire");
    enable(spec, "test_constraint", {{"stiffness_mn_per_mm", stiffness}});
    RigRun held(spec, "tube_wire");
    loose.step({}, 100);
    held.step({}, 100);
    const SoftBodyModel& wall = *held.parts.wall;
    const double heaviest = *std::max_element(wall.mass.begin(), wall.mass.end());
    EXPECT_GT(loose.channels.wall_displacement_max_mm, 0.01);
    EXPECT_LE(held.channels.wall_displacement_max_mm, 1.02 * heaviest * acceleration / stiffness);
    EXPECT_TRUE(held.finite());
}

TEST(Overlay, EveryEffectThatCanBeFoundRunsWhereOneSwitchesItOn) {
    const TemporaryFolder folder;
    std::shared_ptr<const SceneModels> elastic;
    for (const EffectInfo& info : effect_table()) {
        if (info.for_tests) continue;
        std::string text = info.elastic_wall ? "[wall]\nform = \"elastic\"\n" : "";
        text += "[effects." + std::string(info.name) + "]\nenabled = true\n";
        for (const Parameter& p : info.parameters) {
            const bool strength =
                std::find(info.strengths.begin(), info.strengths.end(), p.key) != info.strengths.end();
            if (strength && p.default_value == 0.0)
                text += std::string(p.key) + " = " + std::to_string(0.02 * p.maximum) + "\n";
        }
        const SceneSpec spec = rig_spec("fork", {folder.write("o.toml", text)});
        if (info.elastic_wall && !elastic) elastic = build_models(spec, {});
        RigRun run(build_world(spec, info.elastic_wall ? *elastic : rig_models("fork"), spec.seed, 1));
        for (int k = 0; k < 4; ++k) run.step(busy_hands(k));
        EXPECT_TRUE(run.finite()) << info.name;
    }
}

}  // namespace
}  // namespace cathlab
