// What a study's report draws from force maps and questionnaires.
#include "study/study_report.h"

#include <gtest/gtest.h>

namespace cathlab {
namespace {

TEST(LikertBars, CountTheAnswersOfEachGroupAndLeaveOutTheSilent) {
    Answers one, two;
    one.sheets[0][0] = 5;
    two.sheets[0][0] = 4;
    two.sheets[0][10] = 1;
    const auto bars = likert_bars({{"expert", {one, two}}, {"novice", {Answers()}}});
    ASSERT_EQ(bars.size(), 1U);
    ASSERT_EQ(bars[0].rows.size(), 11U);
    EXPECT_EQ(bars[0].rows[0].counts, (std::vector<int>{0, 0, 0, 1, 1}));
    EXPECT_EQ(bars[0].rows[10].counts, (std::vector<int>{1, 0, 0, 0, 0}));
    EXPECT_EQ(bars[0].rows[5].counts, (std::vector<int>{0, 0, 0, 0, 0}));
}

TEST(ScalesTable, HasARowForEachGroupThatAnsweredAWholeScale) {
    Answers half, whole;
    half.sheets[1][0] = 3;
    for (auto& answer : whole.sheets[1]) answer = 3;
    const PageTable table = scales_table({{"expert", {half}}, {"novice", {whole, half}}});
    ASSERT_EQ(table.rows.size(), 1U);
    EXPECT_EQ(table.rows[0][0], "novice");
    EXPECT_EQ(table.rows[0][1].substr(0, 2), "50");
    EXPECT_EQ(table.rows[0][2], "-");
}

TEST(ForceMaps, AreDrawnToOneScaleByTheMeanOfARun) {
    EXPECT_TRUE(force_maps({{"expert", 2, {}}}).empty());
    UnrolledForces light, hard;
    light.impulse_ns.assign(UnrolledForces::sectors, 0.0);
    hard.impulse_ns.assign(2 * UnrolledForces::sectors, 0.0);
    light.impulse_ns[3] = 2.0;
    hard.impulse_ns[UnrolledForces::sectors + 4] = 9.0;
    const auto maps = force_maps({{"expert", 2, light}, {"novice", 3, hard}});
    ASSERT_EQ(maps.size(), 2U);
    EXPECT_EQ(maps[0].columns, 2);
    EXPECT_EQ(maps[0].rows, UnrolledForces::sectors);
    EXPECT_DOUBLE_EQ(maps[0].most, 3.0);
    EXPECT_DOUBLE_EQ(maps[1].most, 3.0);
    EXPECT_DOUBLE_EQ(maps[0].values[3 * 2 + 0], 1.0);
    EXPECT_DOUBLE_EQ(maps[1].values[4 * 2 + 1], 3.0);
}

RunEntry trial(const std::string& participant, double play_time_s) {
    RunEntry run;
    run.folder = "runs/" + participant + "/a-1";
    run.participant = participant;
    run.group = "expert";
    run.task = "a";
    run.trial = 1;
    run.metrics["play_time_s"] = play_time_s;
    return run;
}

TEST(StudyPage, LeadsToEachTrialAndSaysWhichOfThemWereVerified) {
    const Protocol protocol{"s", {"expert"}, {"a"}, 1};
    const std::vector<RunEntry> runs{trial("P01", 10.0), trial("P02", 20.0)};
    const std::string silent = html_page(study_page(protocol, {}, runs));
    EXPECT_NE(silent.find("Not verified"), std::string::npos);
    EXPECT_EQ(silent.find("href"), std::string::npos);
    const std::string page = html_page(
        study_page(protocol, {}, runs,
                   {{runs[0].folder, {"trials/P01-a-1.html", "yes"}}, {runs[1].folder, {"", "a & b differ"}}}));
    EXPECT_NE(page.find("<a href=\"trials/P01-a-1.html\">runs/P01/a-1</a>"), std::string::npos);
    EXPECT_NE(page.find("<td>runs/P02/a-1</td>"), std::string::npos);
    EXPECT_NE(page.find("of 2 runs stepped again from their inputs, 1 agree"), std::string::npos);
    EXPECT_NE(page.find("a &amp; b differ"), std::string::npos);
}

}  // namespace
}  // namespace cathlab
