// A study folder: orders, participants, bad files.
#include "study/protocol.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <set>

#include "core/errors.h"
#include "study/study_report.h"

namespace cathlab {
namespace {

namespace fs = std::filesystem;

class Study : public testing::Test {
protected:
    void SetUp() override { fs::remove_all(folder_); }
    void TearDown() override { fs::remove_all(folder_); }
    std::string complaint(const auto& f) {
        try {
            f();
        } catch (const UserError& error) {
            return error.what();
        }
        return "";
    }
    void write(const std::string& name, const std::string& text) { std::ofstream(folder_ + "/" + name) << text; }

    std::string folder_ = testing::TempDir() + "cathlab_study_" + std::to_string(getpid()) +
                          testing::UnitTest::GetInstance()->current_test_info()->name();
    Protocol protocol_{"trial", {"expert", "novice"}, {"a", "b", "c", "d"}, 2};
};

TEST(BalancedOrder, IsALatinSquareInWhichEachTaskFollowsEachOtherEquallyOften) {
    constexpr int n = 6;
    std::map<std::pair<int, int>, int> after;
    for (int place = 0; place < n; ++place) {
        std::set<int> seen;
        for (int p = 0; p < n; ++p) seen.insert(balanced_order(n, p)[static_cast<std::size_t>(place)]);
        EXPECT_EQ(seen.size(), static_cast<std::size_t>(n));
    }
    for (int p = 0; p < n; ++p) {
        const std::vector<int> order = balanced_order(n, p);
        for (std::size_t k = 1; k < order.size(); ++k) ++after[{order[k - 1], order[k]}];
    }
    EXPECT_EQ(after.size(), static_cast<std::size_t>(n * (n - 1)));
    for (const auto& [pair, count] : after) EXPECT_EQ(count, 1);
}

TEST_F(Study, KeepsItsProtocolAndItsParticipants) {
    write_study(folder_, protocol_);
    add_participant(folder_, protocol_, {"P01", "expert", false});
    add_participant(folder_, protocol_, {"S02", "novice", true});
    const Protocol read = read_study(folder_);
    EXPECT_EQ(read.tasks, protocol_.tasks);
    EXPECT_EQ(read.trials, 2);
    const auto participants = read_participants(folder_, read);
    ASSERT_EQ(participants.size(), 2U);
    EXPECT_TRUE(participants[1].synthetic);
    const auto trials = schedule(read, participants);
    ASSERT_EQ(trials.size(), 16U);
    std::set<std::string> folders;
    for (const Trial& trial : trials) folders.insert(trial.folder);
    EXPECT_EQ(folders.size(), trials.size());
    for (std::size_t k = 0; k < 4; ++k) EXPECT_EQ(trials[k].trial, 1) << "all first trials come before the second ones";
}

TEST_F(Study, RefusesWhoIsThereAlreadyAndWhatIsNoPseudonym) {
    write_study(folder_, protocol_);
    add_participant(folder_, protocol_, {"P01", "expert", false});
    EXPECT_NE(complaint([&] {
                  add_participant(folder_, protocol_, {"p01", "novice", false});
              }).find("takes part already"),
              std::string::npos);
    EXPECT_NE(complaint([&] {
                  add_participant(folder_, protocol_, {"Ann Lee", "novice", false});
              }).find("no pseudonym"),
              std::string::npos);
    EXPECT_NE(complaint([&] {
                  add_participant(folder_, protocol_, {"P02", "novic", false});
              }).find("novice"),
              std::string::npos);
    EXPECT_NE(complaint([&] { write_study(folder_, protocol_); }).find("holds a study already"), std::string::npos);
    EXPECT_EQ(read_participants(folder_, protocol_).size(), 1U);
}

TEST_F(Study, NamesWhatIsWrongWithItsFiles) {
    EXPECT_NE(complaint([&] { read_study(folder_); }).find("study init"), std::string::npos);
    write_study(folder_, protocol_);
    for (const char* bad :
         {"", "[]", "{", R"({"schema": 1})", R"({"schema": 2, "groups": ["a"], "tasks": ["a"]})",
          R"({"schema": 1, "groups": "a", "tasks": ["a"]})", R"({"schema": 1, "groups": ["a"], "tasks": ["a", "a"]})",
          R"({"schema": 1, "groups": ["a"], "tasks": [], "trials": 2})",
          R"({"schema": 1, "groups": ["a"], "tasks": ["../a"], "trials": 2})",
          R"({"schema": 1, "groups": ["a"], "tasks": ["a"], "trials": 0})",
          R"({"schema": 1, "groups": ["a"], "tasks": ["a"], "trails": 2})"}) {
        write("study.json", bad);
        EXPECT_NE(complaint([&] { read_study(folder_); }).find("study.json"), std::string::npos) << bad;
    }
    for (const char* bad :
         {"", "name\n", "pseudonym,group,synthetic\nP01\n", "pseudonym,group,synthetic\nP01,expert\n",
          "pseudonym,group,synthetic\nP01,experts,no\n", "pseudonym,group,synthetic\nP01,expert,no\np01,novice,no\n"}) {
        write("participants.csv", bad);
        EXPECT_NE(complaint([&] { read_participants(folder_, protocol_); }).find("participants.csv"), std::string::npos)
            << bad;
    }
}

RunEntry run(const std::string& who, const std::string& group, const std::string& task, double time) {
    RunEntry out;
    out.folder = "runs/" + who + "/" + task + "-2";
    out.participant = who;
    out.group = group;
    out.task = task;
    out.trial = 2;
    out.metrics = {{"play_time_s", time}, {"accumulated_collision_n", 2.0 * time}};
    return out;
}

TEST_F(Study, ReportsWhatItCanAndSaysWhatItCannot) {
    const std::string empty = html_page(study_page(protocol_, {}, {}));
    EXPECT_NE(empty.find("No run is there yet"), std::string::npos);
    std::vector<RunEntry> runs;
    for (int k = 0; k < 6; ++k) {
        runs.push_back(run("E" + std::to_string(k), "expert", "a", 20.0 + k));
        runs.back().metrics["goal_reached"] = k < 4 ? 1.0 : 0.0;
        runs.push_back(run("N" + std::to_string(k), "novice", "a", 60.0 + 2 * k));
        runs.back().metrics["goal_reached"] = 1.0;
    }
    const Page page = study_page(protocol_, {{"E0", "expert", true}}, runs);
    ASSERT_FALSE(page.tables.empty());
    const std::vector<std::string>& row = page.tables.front().rows.front();
    EXPECT_EQ(row[1], "22.5 ± 1.87 (6)");
    EXPECT_EQ(row[2], "65 ± 3.74 (6)");
    EXPECT_EQ(row[3], "0.0039");  // H = 8.3077, chi-squared with one degree of freedom
    EXPECT_EQ(page.tables.front().rows[1][1], "-");
    EXPECT_NE(html_page(page).find("SYNTHETIC"), std::string::npos);
    EXPECT_EQ(page.tables.back().rows[0], (std::vector<std::string>{"a", "4 of 6", "6 of 6"}));
    EXPECT_EQ(page.tables.back().rows[1][1], "-");
    Protocol one = protocol_;
    one.groups = {"expert"};
    EXPECT_NE(html_page(study_page(one, {}, runs)).find("no test is computed"), std::string::npos);
    EXPECT_NE(trials_csv(runs).find("runs/E0/a-2,E0,expert,a,2,yes"), std::string::npos);
}

}  // namespace
}  // namespace cathlab
