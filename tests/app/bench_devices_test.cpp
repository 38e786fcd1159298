// `cathlab bench wire`, `contact` and `step` print what they measured, as text and as JSON.  No time is judged here.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "app/program.h"

namespace cathlab {
namespace {

using Json = nlohmann::json;

Json json_of(const std::string& command) {
    const Outcome outcome = call(command);
    EXPECT_EQ(outcome.code, 0) << outcome.text;
    return Json::parse(outcome.text);
}

TEST(BenchDevices, TheWiresSolveIsMeasuredForFourLengths) {
    const Json all = json_of("bench wire --quick --json");
    ASSERT_EQ(all.at("solve").size(), 4U);
    for (const Json& row : all["solve"])
        for (const char* key : {"links", "free_median_ms", "free_p99_ms", "us_per_link", "touching_median_ms"})
            EXPECT_GT(row.at(key).get<double>(), 0.0) << key;
}

TEST(BenchDevices, ContactIsMeasuredInAScene) {
    const Json all = json_of("bench contact --scene scenes/rigs/fork.toml --seconds 0.2 --quick --json");
    for (const char* key : {"triangles", "particles", "refit_median_ms", "closest_us", "closest_near_with_hint_us"})
        EXPECT_GT(all.at(key).get<double>(), 0.0) << key;
}

TEST(BenchDevices, TheStepIsMeasuredOnEachNumberOfThreadsAndSaysHowItIsCutUp) {
    const Json all = json_of("bench step --scene scenes/rigs/fork.toml --seconds 0.2 --threads 1 2 --json");
    EXPECT_EQ(all.at("substeps"), 4);
    EXPECT_EQ(all.at("iterations"), 2);
    ASSERT_EQ(all.at("runs").size(), 2U);
    EXPECT_EQ(all["runs"][1]["threads"], 2);
    for (const Json& run : all["runs"]) EXPECT_GT(run.at("s_per_simulated_s").get<double>(), 0.0);
    EXPECT_EQ(call("bench step --scene no-such-scene").code, 1);
    EXPECT_EQ(call("bench step --threads 0").code, 2);
}

}  // namespace
}  // namespace cathlab
