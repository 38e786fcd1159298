// `cathlab bench wall` prints what it measured, all of it, as text and as JSON.  No time is judged here.
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "app/program.h"

namespace cathlab {
namespace {

using Json = nlohmann::json;

void expect_numbers(const Json& all, const char* of, const std::vector<const char*>& keys) {
    ASSERT_TRUE(all.contains(of)) << of;
    for (const char* key : keys) {
        ASSERT_TRUE(all.at(of).contains(key)) << of << "." << key;
        const Json& value = all.at(of).at(key);
        ASSERT_TRUE(value.is_number()) << of << "." << key;  // JSON writes what is no number as null
        EXPECT_GT(value.get<double>(), 0.0) << of << "." << key;
    }
}

TEST(BenchWall, ItsJsonHoldsEveryFigureOfTheTable) {
    const Outcome outcome = call("bench wall --quick --json --threads 2");
    ASSERT_EQ(outcome.code, 0) << outcome.text;
    const Json all = Json::parse(outcome.text);
    expect_numbers(all, "wall", {"particles", "clusters", "memberships", "passes"});
    EXPECT_NEAR(all["wall"]["particles"].get<double>(), 10000.0, 200.0);
    EXPECT_NEAR(all["wall"]["clusters"].get<double>(), 590.0, 12.0);
    EXPECT_NEAR(all["wall"]["memberships"].get<double>(), 70000.0, 2000.0);
    EXPECT_EQ(all["wall"]["passes"], 4);
    expect_numbers(all, "one_thread", {"median_ms", "p99_ms", "count"});
    expect_numbers(all, "threads", {"median_ms", "p99_ms", "count", "threads", "times_faster"});
    expect_numbers(all, "core_taken", {"median_ms", "p99_ms", "count", "threads", "p99_over_median"});
    expect_numbers(all, "arithmetic_floor",
                   {"operations", "ms", "times_floor", "all_in_float_ms", "times_all_in_float"});
    expect_numbers(all, "memory_floor", {"bytes", "copy_gb_per_s", "ms", "times_floor"});
    expect_numbers(all, "peer",
                   {"passes", "median_ms", "p99_ms", "pass_over_our_pass", "pass_over_our_step", "with_tree_median_ms",
                    "with_tree_over_our_pass"});
    expect_numbers(all, "spread", {"time"});
    ASSERT_EQ(all.at("sizes").size(), 3U);
    double wanted = 1000.0;
    for (const Json& row : all.at("sizes")) {
        EXPECT_NEAR(row.at("particles").get<double>(), wanted, 0.05 * wanted);
        EXPECT_GT(row.at("median_ms").get<double>(), 0.0);
        EXPECT_TRUE(row.contains("bytes_per_particle"));
        wanted *= 10.0;
    }
}

TEST(BenchWall, WrongUseEndsWithTwo) {
    EXPECT_EQ(call("bench wall --threads 1").code, 2);
    EXPECT_EQ(call("bench wall --precision half").code, 2);
}

TEST(BenchWall, ASceneIsStillMeasuredByItsName) {
    const Outcome outcome = call("bench no-such-scene");
    EXPECT_NE(outcome.code, 0);
    EXPECT_NE(outcome.text.find("no-such-scene"), std::string::npos) << outcome.text;
}

}  // namespace
}  // namespace cathlab
