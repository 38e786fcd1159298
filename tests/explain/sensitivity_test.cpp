// Which effects a recording cannot tell apart, said before anything acted in it.
#include "explain/sensitivity.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "core/errors.h"
#include "explain/recording.h"

using namespace cathlab;

TEST(Sensitivity, ASlowWanderIsADriftAndAlternansIsNone) {
    const auto folder = explain_test::record({"heart-motion", "", 1, 21, 240});
    ExplainOptions options;
    options.threads = 3;
    const Sensitivity found = sensitivity(read_dataset(folder->path()), options);
    const auto left = [&](const std::string& acting, const std::string& fitted) {
        const auto it = std::find_if(found.pairs.begin(), found.pairs.end(),
                                     [&](const Likeness& p) { return p.acting == acting && p.fitted == fitted; });
        EXPECT_NE(it, found.pairs.end()) << acting << " " << fitted;
        return it == found.pairs.end() ? -1.0 : it->left;
    };
    EXPECT_LT(left("sensor-drift", "baseline-wander"), told_apart);
    EXPECT_GT(left("alternans", "amplitude-drift"), 0.7);
    EXPECT_GT(left("alternans", "sensor-drift"), 0.9);
    EXPECT_TRUE(std::is_sorted(found.pairs.begin(), found.pairs.end(),
                               [](const Likeness& a, const Likeness& b) { return a.left < b.left; }));
    // No beat of this recording comes early.
    EXPECT_EQ(found.taken_up, std::vector<std::string>{"ectopic-beats"});
}

TEST(Sensitivity, IsStopped) {
    const auto folder = explain_test::record({"heart-motion", "", 1, 21, 240});
    ExplainOptions options;
    options.on_progress = [](double) { return false; };
    EXPECT_THROW(sensitivity(read_dataset(folder->path()), options), UserError);
}
