// The page on which one trial can be watched.
#include "study/trial_page.h"

#include <gtest/gtest.h>

namespace cathlab {
namespace {

CentrelineGraph one_vessel() {
    CentrelineGraph graph;
    graph.nodes = {{Vec3(0.0, 0.0, 0.0), 5.0, 0}, {Vec3(10.0, 20.0, 100.0), 3.0, 0}};
    graph.edges = {{0, 1}};
    return graph;
}

RunEntry run() {
    RunEntry entry;
    entry.folder = "runs/P01/a-2";
    entry.participant = "P01";
    entry.group = "<novice>";
    entry.task = "a";
    entry.trial = 2;
    return entry;
}

bool has(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

TEST(TrialPage, HoldsEveryFrameTheVesselsFromTwoSidesAndTheWayToTheReport) {
    const std::vector<TrialFrame> frames{
        {0.0, Vec3(1.0, 2.0, 3.0), 0.0, false},
        {0.1, Vec3(4.0, 5.0, 6.04), 0.25, true, -30.0, 20.0, {Vec3(4.0, 5.0, 6.04), Vec3(4.04, 4.94, 2.04)}}};
    const std::string page = trial_page(run(), one_vessel(), frames, 2.0, "verified", "../report.html");
    EXPECT_TRUE(has(page, "[0.00,1.0,2.0,3.0,0.000,0,0.0,0.0,[]],"));
    EXPECT_TRUE(has(page, "[0.10,4.0,5.0,6.0,0.250,1,-30.0,20.0,[40,50,60,0,-1,-40,]],"));
    EXPECT_TRUE(has(page, "points=\"0.0,-0.0 10.0,-100.0\" stroke-width=\"8.0\"")) << "from the front: x, z up";
    EXPECT_TRUE(has(page, "points=\"0.0,-0.0 20.0,-100.0\" stroke-width=\"8.0\"")) << "from the left: y, z up";
    EXPECT_TRUE(has(page, "href=\"../report.html\""));
    EXPECT_TRUE(has(page, "verified"));
    EXPECT_TRUE(has(page, "runs/P01/a-2"));
    EXPECT_TRUE(has(page, "&lt;novice&gt;")) << "names are escaped";
    EXPECT_FALSE(has(page, "http")) << "nothing comes from elsewhere";
}

TEST(TrialPage, OfAnEmptyTrialSaysSo) {
    const std::string page = trial_page(run(), one_vessel(), {}, 2.0, "", "../report.html");
    EXPECT_TRUE(has(page, "Nothing was recorded"));
    EXPECT_FALSE(has(page, "<script>"));
}

}  // namespace
}  // namespace cathlab
