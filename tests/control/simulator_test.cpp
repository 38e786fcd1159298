// A world that code steps, resets and seeds.
#include "control/simulator.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <limits>
#include <sstream>
#include <thread>

#include "core/errors.h"

namespace cathlab {
namespace {

const std::string root = CATHLAB_SOURCE_DIR;
const std::string fork = root + "/scenes/rigs/fork.toml";

std::vector<double> run(Simulator& simulator, int steps = 60) {
    std::vector<double> action = simulator.idle(), seen(Simulator::observation_size());
    action[Simulator::action("advance")] = 50.0;
    action[Simulator::action("device")] = 1.0;
    for (int k = 0; k < steps; ++k) {
        action[Simulator::action("distal_bend")] = k;
        simulator.step(action, seen);
    }
    return seen;
}

TEST(Simulator, ResetWithOneSeedGivesTheSameBitsWhateverWentBefore) {
    Simulator simulator(fork, root);
    const std::vector<double> first = run(simulator);
    const std::uint64_t hash = simulator.state_hash();
    run(simulator, 25);
    EXPECT_NE(simulator.state_hash(), hash);
    simulator.reset(1);
    EXPECT_EQ(simulator.channels().time_s, 0.0);
    EXPECT_EQ(run(simulator), first);
    EXPECT_EQ(simulator.state_hash(), hash);
    Simulator other = simulator.another();
    EXPECT_EQ(run(other), first);
}

TEST(Simulator, TwoSideBySideOnThreadsOfTheirOwnDoNotSeeEachOther) {
    Simulator one(fork, root);
    Simulator two = one.another();
    std::vector<double> a, b;
    std::thread first([&] { a = run(one); }), second([&] { b = run(two); });
    first.join();
    second.join();
    EXPECT_EQ(a, b);
    EXPECT_EQ(one.state_hash(), two.state_hash());
}

TEST(Simulator, ObservationsAreTheChannelsAndActionsTheActions) {
    Simulator simulator(fork, root);
    const std::vector<double> seen = run(simulator, 10);
    EXPECT_DOUBLE_EQ(seen[Simulator::observation("time_s")], 10 * simulator.dt_s());
    EXPECT_EQ(seen[Simulator::observation("catheter_insertion_mm")], simulator.channels().catheter_insertion_mm);
    EXPECT_EQ(simulator.idle().size(), Simulator::action_size());
}

TEST(Simulator, WhatIsWrongIsToldOrClamped) {
    EXPECT_THROW(Simulator("no-such-scene", root), UserError);
    Simulator simulator(fork, root);
    EXPECT_THROW(Simulator::action("advanse"), UserError);
    EXPECT_THROW(simulator.step({}, {}), std::logic_error);
    std::vector<double> action(Simulator::action_size(), std::numeric_limits<double>::quiet_NaN());
    std::vector<double> seen(Simulator::observation_size());
    simulator.step(action, seen);
    EXPECT_FALSE(simulator.events().empty());
    action.assign(Simulator::action_size(), 1e6);
    for (int k = 0; k < 50; ++k) simulator.step(action, seen);
    for (const double value : seen) EXPECT_TRUE(std::isfinite(value));
    EXPECT_THROW(simulator.step(action, std::span<double>(seen).first(3)), std::logic_error);
}

std::string text_of(const std::string& path) {
    std::ifstream file(path);
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
}

TEST(ApiDocs, ShowTheExampleThatIsCompiledAndRun) {
    const std::string example = text_of(root + "/tests/control/example/api_example.cpp");
    ASSERT_FALSE(example.empty());
    EXPECT_NE(text_of(root + "/docs/api.md").find("```cpp\n" + example + "```"), std::string::npos)
        << "docs/api.md must show tests/control/example/api_example.cpp as it stands";
}

}  // namespace
}  // namespace cathlab
