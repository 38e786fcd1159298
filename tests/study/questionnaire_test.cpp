// Answers, their scores, and their file.
#include "study/questionnaire.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "core/errors.h"

namespace cathlab {
namespace {

Answers all(int likert, int sus, int tlx) {
    Answers out;
    const int values[] = {likert, sus, tlx};
    for (std::size_t s = 0; s < out.sheets.size(); ++s)
        for (auto& answer : out.sheets[s]) answer = values[s];
    return out;
}

/// A file for as long as the expression that it stands in.
class File {
public:
    explicit File(const std::string& text) { std::ofstream(path_) << text; }
    ~File() { std::filesystem::remove(path_); }
    File(const File&) = delete;
    File& operator=(const File&) = delete;
    operator const std::string&() const { return path_; }

private:
    std::string path_ = testing::TempDir() + "questionnaire-" + std::to_string(getpid()) + ".json";
};

TEST(Questionnaire, HoldsElevenStatementsTenOfTheUsabilityScaleAndSixOfTheTaskLoad) {
    const auto sheets = question_sheets();
    ASSERT_EQ(sheets.size(), 3U);
    EXPECT_EQ(sheets[0].questions.size(), 11U);
    EXPECT_EQ(sheets[1].questions.size(), 10U);
    EXPECT_EQ(sheets[2].questions.size(), 6U);
    EXPECT_EQ(all(3, 3, 50).given(), 27U);
}

TEST(Questionnaire, TheSameAnswerToAllTenIsFiftyAndTheBestOnesAreAHundred) {
    for (int x = 1; x <= 5; ++x) EXPECT_EQ(sus_score(all(1, x, 0)), 50.0);
    Answers best = all(1, 1, 0);
    for (std::size_t i = 0; i < 10; ++i) best.sheets[1][i] = i % 2 == 0 ? 5 : 1;
    EXPECT_EQ(sus_score(best), 100.0);
    EXPECT_EQ(tlx_score(all(1, 1, 35)), 35.0);
}

TEST(Questionnaire, AHalfFilledOneHasNoScoreAndIsReadAgainAsItWas) {
    Answers half;
    half.sheets[0][3] = 4;
    half.sheets[1][0] = 5;
    half.sheets[2][5] = 85;
    EXPECT_FALSE(half.complete());
    EXPECT_FALSE(sus_score(half));
    EXPECT_FALSE(tlx_score(half));
    const Answers read = read_questionnaire(File(questionnaire_json(half)));
    EXPECT_EQ(read.sheets, half.sheets);
    EXPECT_EQ(read.given(), 3U);
    const Answers whole = all(2, 4, 100);
    EXPECT_EQ(read_questionnaire(File(questionnaire_json(whole))).sheets, whole.sheets);
    Answers none;
    none.skipped = true;
    EXPECT_TRUE(read_questionnaire(File(questionnaire_json(none))).skipped);
}

TEST(Questionnaire, WhatIsNoAnswerIsASentenceWithFileAndKey) {
    const auto sentence = [](const std::string& from, const std::string& to) {
        std::string text = questionnaire_json(all(3, 3, 50));
        text.replace(text.find(from), from.size(), to);
        try {
            read_questionnaire(File(text));
        } catch (const UserError& error) {
            return std::string(error.what());
        }
        return std::string();
    };
    EXPECT_NE(sentence("\"picture\": 3", "\"picture\": 6").find("likert.picture"), std::string::npos);
    EXPECT_NE(sentence("\"sus1\": 3", "\"sus1\": 2.5").find("sus.sus1"), std::string::npos);
    EXPECT_NE(sentence("\"mental\": 50", "\"mental\": 52").find("by 5"), std::string::npos);
    EXPECT_NE(sentence("\"mental\"", "\"metal\"").find("tlx.metal"), std::string::npos);
    EXPECT_NE(sentence("\"schema\": 1", "\"schema\": 2").find("version"), std::string::npos);
    EXPECT_THROW(read_questionnaire(testing::TempDir() + "nothing.json"), UserError);
    EXPECT_THROW(read_questionnaire(File("{")), UserError);
}

}  // namespace
}  // namespace cathlab
