#include "study/run_index.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "core/errors.h"
#include "record/manifest.h"

using namespace cathlab;
namespace fs = std::filesystem;

namespace {

class Index : public testing::Test {
protected:
    void SetUp() override {
        const std::string name = testing::UnitTest::GetInstance()->current_test_info()->name();
        root_ = fs::temp_directory_path() / ("cathlab_index_" + name + std::to_string(getpid()));
        fs::create_directories(root_);
    }
    void TearDown() override { fs::remove_all(root_); }

    void write(const std::string& name, const std::string& text) const {
        fs::create_directories((root_ / name).parent_path());
        std::ofstream(root_ / name) << text;
    }
    std::string root() const { return root_.string(); }
    std::string file() const { return (root_ / "index.sqlite").string(); }

    fs::path root_;
};

RunEntry run(const std::string& folder, const std::string& participant, int trial) {
    RunEntry e;
    e.folder = folder;
    e.participant = participant;
    e.group = "novice";
    e.task = "A";
    e.trial = trial;
    e.metrics = {{"play_time_s", 61.25}, {"contacts", 3.0}};
    return e;
}

std::string manifest(bool complete) {
    RunManifest out;
    out.version = "0.1.0";
    out.scene = "scenes/tasks/a.toml";
    out.scene_hash = 0xFF;
    out.dt_s = 0.02;
    out.complete = complete;
    return manifest_json(out);
}

std::string message(const std::function<void()>& action) {
    try {
        action();
    } catch (const UserError& e) {
        return e.what();
    }
    return "";
}

}  // namespace

TEST_F(Index, KeepsWhatItWasGivenAndListsItInOrder) {
    {
        RunIndex index(file(), root());
        index.add(run("runs/2", "P02", 1));
        index.add(run("runs/1b", "P01", 2));
        index.add(run("runs/1a", "P01", 1));
    }
    const RunIndex again(file(), root());
    const auto all = again.list();
    ASSERT_EQ(all.size(), 3U);
    EXPECT_EQ(all[0].folder, "runs/1a");
    EXPECT_EQ(all[1].folder, "runs/1b");
    EXPECT_EQ(all[2].participant, "P02");
    EXPECT_EQ(all[0].metrics.at("play_time_s"), 61.25);
    EXPECT_EQ(all[0].group, "novice");
    EXPECT_EQ(again.list("P01").size(), 2U);
    EXPECT_EQ(again.list("", "B").size(), 0U);
}

TEST_F(Index, AFolderAddedAgainIsReplacedAndATrialIsTakenOnce) {
    RunIndex index(file(), root());
    index.add(run("runs/1", "P01", 1));
    RunEntry changed = run("runs/1", "P01", 1);
    changed.metrics = {{"play_time_s", 50.0}};
    index.add(changed);
    ASSERT_EQ(index.list().size(), 1U);
    EXPECT_EQ(index.list()[0].metrics.size(), 1U);
    const std::string said = message([&] { index.add(run("runs/other", "P01", 1)); });
    EXPECT_NE(said.find("already in runs/1"), std::string::npos) << said;
    EXPECT_EQ(index.list().size(), 1U);
}

TEST_F(Index, TakesPseudonymsOnly) {
    RunIndex index(file(), root());
    EXPECT_NE(message([&] { index.add(run("runs/1", "Jane Doe", 1)); }).find("no pseudonym"), std::string::npos);
    EXPECT_THROW(check_pseudonym("a@b"), UserError);
    EXPECT_THROW(check_pseudonym(""), UserError);
    EXPECT_NO_THROW(check_pseudonym("P-07_x"));
    EXPECT_TRUE(index.list().empty());
}

TEST_F(Index, IsRebuiltFromTheFoldersAndSaysWhatItLeftOut) {
    write("runs/a/manifest.json", manifest(true));
    write("runs/a/trial.json", R"({"participant": "P01", "task": "A", "trial": 1})");
    write("runs/a/metrics.json", R"({"play_time_s": 70.5, "note": "text is no metric"})");
    write("runs/a/result.json", R"({"reached": true, "score": 81.5, "aids": {"inner_view_s": 12.0}})");
    write("runs/cut/manifest.json", manifest(false));
    write("runs/cut/trial.json", R"({"participant": "P01", "task": "A", "trial": 2})");
    write("runs/broken/manifest.json", "{\"participant\": ");
    write("runs/lost/manifest.json", manifest(true));
    write("runs/half.part/manifest.json", manifest(false));
    write("runs/half.part/trial.json", R"({"participant": "P01", "task": "A", "trial": 1})");
    write("runs/typed/manifest.json", manifest(true));
    write("runs/typed/trial.json", R"({"participant": 7})");
    RunIndex index(file(), root());
    index.add(run("runs/gone", "P09", 1));
    const auto rebuilt = index.rebuild();
    EXPECT_EQ(rebuilt.added, 2) << (rebuilt.left_out.empty() ? "" : rebuilt.left_out[0]);
    ASSERT_EQ(rebuilt.left_out.size(), 4U);
    EXPECT_EQ(rebuilt.left_out[0], "runs/half.part: a trial that was broken off; it is to be run again");
    EXPECT_NE(rebuilt.left_out[1].find("broken/manifest.json"), std::string::npos);
    EXPECT_NE(rebuilt.left_out[2].find("lost/metrics.json: is missing"), std::string::npos);
    EXPECT_NE(rebuilt.left_out[3].find("participant: has the wrong type: 7"), std::string::npos);
    const auto all = index.list();
    ASSERT_EQ(all.size(), 2U);
    EXPECT_EQ(all[0].folder, "runs/a");
    EXPECT_EQ(all[0].participant, "P01");
    EXPECT_EQ(all[0].scene_hash, "00000000000000ff");
    EXPECT_EQ(all[0].metrics,
              (std::map<std::string, double>{
                  {"play_time_s", 70.5}, {"goal_reached", 1.0}, {"score", 81.5}, {"inner_view_s", 12.0}}));
    EXPECT_FALSE(all[1].complete);
}

TEST_F(Index, RefusesAFileThatIsNoIndexOrCannotBe) {
    write("index.sqlite", std::string(4096, 'x'));
    EXPECT_NE(message([&] { RunIndex(file(), root()); }), "");
    EXPECT_NE(message([&] { RunIndex(root() + "/no/such/folder.sqlite", root()); }), "");
    RunIndex index((root_ / "good.sqlite").string(), root() + "/nowhere");
    EXPECT_NE(message([&] { index.rebuild(); }).find("cannot be read"), std::string::npos);
}
