// The autopilot brings a wire to its goal in a scene, by the actions alone, and does it again to the bit.
#include "autopilot/autopilot.h"

#include <gtest/gtest.h>

#include "control/simulator.h"
#include "scene/load_scene.h"

namespace cathlab {
namespace {

struct Outcome {
    bool reached = false;
    double seconds = 0.0, bar = 0.0;
    std::uint64_t hash = 0;
};

Outcome fly(const std::string& task_file, const std::string& skill, double most_s) {
    const std::string root = CATHLAB_SOURCE_DIR;
    const SceneSpec scene = load_scene(root + "/scenes/tasks/" + task_file, {}, root);
    Simulator simulator(scene.path, root, testing::TempDir() + "cathlab_cache");
    simulator.reset(1);
    const TaskSpec task = *task_of(scene);
    Autopilot pilot(simulator.world(), scene, task, find_skill(skill), 1);
    const GoalPoint goal(simulator.world(), task);
    GoalTracker tracker(task);
    Outcome out;
    while (tracker.outcome() == GoalTracker::Outcome::open && out.seconds < most_s) {
        const Input input = pilot.act(simulator.world(), simulator.channels(), Input{});
        std::vector<double> action;
        for (const ActionInfo& info : action_table()) action.push_back(input.*info.value);
        simulator.step(action, {});
        tracker.add(simulator.channels(), goal.now(simulator.world()), simulator.dt_s());
        out.seconds += simulator.dt_s();
        out.bar = std::max(out.bar, simulator.channels().force_bar);
    }
    out.reached = tracker.outcome() == GoalTracker::Outcome::reached;
    out.hash = simulator.state_hash();
    return out;
}

TEST(Autopilot, AnExpertBringsTheWireIntoTheAbdominalAortaUnderTheLimitAndAgainToTheBit) {
    const Outcome one = fly("a.toml", "expert", 60.0);
    EXPECT_TRUE(one.reached);
    EXPECT_LT(one.bar, 1.0);
    const Outcome two = fly("a.toml", "expert", 60.0);
    EXPECT_EQ(one.hash, two.hash);
    EXPECT_EQ(one.seconds, two.seconds);
}

TEST(Autopilot, AnExpertBringsTheWireFromEitherCoronaryOstiumToItsTarget) {
    for (const char* task : {"d.toml", "e.toml"}) {
        const Outcome out = fly(task, "expert", 120.0);
        EXPECT_TRUE(out.reached) << task;
        EXPECT_LT(out.bar, 1.0) << task;
    }
}

TEST(Autopilot, AnExpertBringsTheCatheterToEitherCoronaryOstiumAndANoviceTakesLongerAndPressesHarder) {
    double expert_bar = 0.0, novice_bar = 0.0;
    for (const char* task : {"b.toml", "c.toml"}) {
        const Outcome expert = fly(task, "expert", 120.0), novice = fly(task, "novice", 300.0);
        EXPECT_TRUE(expert.reached) << task;
        EXPECT_LT(expert.bar, 1.0) << task;
        EXPECT_GT(novice.seconds, expert.seconds) << task;
        expert_bar += expert.bar;
        novice_bar += novice.bar;
    }
    EXPECT_GT(novice_bar, expert_bar);
}

TEST(Tasks, EveryOneOfTheProjectIsValidAndItsGoalCanBeReachedByVessels) {
    const std::string root = CATHLAB_SOURCE_DIR, folder = root + "/scenes/tasks";
    for (const std::string& name : names_in_folder(folder, ".toml")) {
        std::string file = folder;
        file.append("/").append(name).append(".toml");
        const SceneSpec scene = load_scene(file, {}, root);
        ASSERT_TRUE(task_of(scene)) << name;
        EXPECT_FALSE(task_of(scene)->instructions.empty()) << name;
        EXPECT_FALSE(task_of(scene)->criteria.empty()) << name;
    }
}

}  // namespace
}  // namespace cathlab
