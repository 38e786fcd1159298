// `cathlab bench fluoroscopy` measures every part on every number of threads, and the pictures are the same.  No time
// is judged here.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "app/program.h"

namespace cathlab {
namespace {

TEST(BenchFluoroscopy, ItsJsonHoldsEveryRunAndItsParts) {
    const Outcome outcome =
        call("bench fluoroscopy --scene " + std::string(CATHLAB_SOURCE_DIR) +
             "/scenes/rigs/fork.toml --seconds 0.3 --size 128 96 --threads 1 2 --pictures 3 --json");
    ASSERT_EQ(outcome.code, 0) << outcome.text;
    const nlohmann::json all = nlohmann::json::parse(outcome.text);
    EXPECT_EQ(all.at("open_rays"), 0);
    EXPECT_EQ(all.at("same_bytes"), true);
    EXPECT_GT(all.at("triangles").get<int>(), 0);
    EXPECT_GT(all.at("device_pieces").get<int>(), 0);
    ASSERT_EQ(all.at("runs").size(), 8U);  // sizes x threads x C-arm still, turning
    for (const auto& run : all.at("runs")) {
        EXPECT_GT(run.at("median_ms").get<double>(), 0.0);
        EXPECT_GT(run.at("per_second").get<double>(), 0.0);
        EXPECT_EQ(run.at("count"), 3);
        for (const char* part : {"lumen", "devices", "beam", "detector", "display"})
            EXPECT_TRUE(run.at("mean_ms").contains(part)) << part;
        EXPECT_EQ(run.at("mean_ms").contains("context"), run.at("c_arm") == "turning");
    }
}

TEST(BenchFluoroscopy, WrongUseEndsWithTwo) {
    EXPECT_EQ(call("bench fluoroscopy --size 63").code, 2);
    EXPECT_EQ(call("bench fluoroscopy --threads 0").code, 2);
}

}  // namespace
}  // namespace cathlab
