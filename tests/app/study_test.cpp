// A study from its protocol to its verified report, by three commands.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "program.h"
#include "record/sums.h"
#include "scene/temporary_folder.h"

namespace cathlab {
namespace {

std::string text_of(const std::string& path) {
    std::ifstream in(path);
    return {std::istreambuf_iterator<char>(in), {}};
}

TEST(Study, IsRehearsedVerifiedAndReportedByThreeCommandsAndAChangedByteIsFound) {
    const TemporaryFolder folder;
    const std::string study = folder.path("study");
    ASSERT_EQ(call("study init " + study + " --tasks e --trials 1").code, 0);
    ASSERT_EQ(call("study rehearse " + study + " --participants 2 --threads 2").code, 0);
    const Outcome reported = call("study report " + study + " --verify --threads 2");
    ASSERT_EQ(reported.code, 0) << reported.text;
    const std::string page = text_of(study + "/report.html");
    EXPECT_NE(page.find("of 2 runs stepped again from their inputs, 2 agree"), std::string::npos);
    EXPECT_NE(page.find("SYNTHETIC"), std::string::npos);
    EXPECT_NE(page.find("href=\"trials/S01-e-1.html\""), std::string::npos);
    EXPECT_NE(text_of(study + "/trials/S02-e-1.html").find("verified: its inputs give the same run"),
              std::string::npos);

    // One digit of one channel in one row of one run.
    const std::string trace = study + "/runs/S01/e-1/trace.csv";
    std::string rows = text_of(trace);
    const std::size_t place = rows.find_last_of("12345678");
    ++rows[place];
    std::ofstream(trace) << rows;
    const Outcome changed = call("study report " + study + " --verify --threads 2");
    EXPECT_EQ(changed.code, 1);
    EXPECT_NE(changed.text.find("DIFFERS: runs/S01/e-1"), std::string::npos) << changed.text;
    EXPECT_NE(text_of(study + "/report.html").find("2 runs stepped again from their inputs, 1 agree"),
              std::string::npos);

    // What only a second look at the run can find: an edited result or event whose sum was made to fit.
    --rows[place];
    std::ofstream(trace) << rows;
    const std::string run = study + "/runs/S01/e-1";
    EXPECT_EQ(call("score " + run + " --threads 2").code, 0);
    const std::string result = text_of(run + "/result.json");
    std::string better = result;
    better.insert(better.find("\"score\": ") + 9, "1");
    std::ofstream(run + "/result.json") << better;
    std::ofstream(run + "/events.jsonl", std::ios::app) << "{}\n";
    write_sums(run);
    const Outcome scored = call("score " + run + " --threads 2");
    EXPECT_EQ(scored.code, 1);
    EXPECT_NE(scored.text.find("result.json is not what the inputs say"), std::string::npos) << scored.text;
    EXPECT_NE(scored.text.find("events.jsonl is not what the inputs say"), std::string::npos) << scored.text;

    EXPECT_EQ(call("study report " + study).code, 0) << "without --verify nobody looks";
    EXPECT_NE(text_of(study + "/report.html").find("Not verified"), std::string::npos);
}

TEST(Study, ARehearsalThatIsStartedAgainGoesOnWithWhatIsMissing) {
    const TemporaryFolder folder;
    const std::string study = folder.path("study");
    ASSERT_EQ(call("study init " + study + " --tasks e --trials 1 --groups expert").code, 0);
    ASSERT_EQ(call("study rehearse " + study + " --participants 1").code, 0);
    // As one that was killed leaves it: half a run under another name.
    std::filesystem::rename(study + "/runs/S01/e-1", study + "/runs/S01/e-1.part");
    std::filesystem::remove(study + "/runs/S01/e-1.part/metrics.json");
    EXPECT_NE(call("study status " + study).text.find("0 of 1 trials are done"), std::string::npos);
    ASSERT_EQ(call("study rehearse " + study + " --participants 1").code, 0);
    EXPECT_NE(call("study status " + study).text.find("1 of 1 trials are done"), std::string::npos);
    EXPECT_FALSE(std::filesystem::exists(study + "/runs/S01/e-1.part"));
}

}  // namespace
}  // namespace cathlab
