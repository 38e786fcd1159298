// One changed byte in a run folder is found.
#include "record/sums.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>

#include "core/errors.h"

namespace cathlab {
namespace {

namespace fs = std::filesystem;

class Sums : public testing::Test {
protected:
    void SetUp() override {
        fs::remove_all(folder_);
        fs::create_directories(folder_);
        write("inputs.jsonl", "{\"step\": 0}\n");
        write("trace.csv", std::string(5000, 'x'));
        write_sums(folder_);
    }
    void TearDown() override { fs::remove_all(folder_); }
    void write(const std::string& name, const std::string& text) {
        std::ofstream(folder_ + "/" + name, std::ios::binary) << text;
    }
    std::string folder_ = testing::TempDir() + "cathlab_sums_" + std::to_string(getpid()) +
                          testing::UnitTest::GetInstance()->current_test_info()->name();
};

TEST_F(Sums, AWholeFolderIsWhole) {
    EXPECT_TRUE(check_sums(folder_).empty());
}

TEST_F(Sums, EveryChangedByteOfAFileIsFound) {
    for (const std::size_t place : {std::size_t{0}, std::size_t{1234}, std::size_t{4999}}) {
        std::string text(5000, 'x');
        text[place] = 'y';
        write("trace.csv", text);
        ASSERT_EQ(check_sums(folder_).size(), 1U);
        EXPECT_NE(check_sums(folder_).front().find("trace.csv was changed"), std::string::npos);
    }
}

TEST_F(Sums, NoByteOfAnyFileNorOfTheListItselfCanBeChanged) {
    write("inputs.jsonl", "{\"step\": 0}\n");
    write("trace.csv", "step\n0\n");
    write_sums(folder_);
    for (const char* name : {"inputs.jsonl", "trace.csv", "sums.json"}) {
        std::ifstream in(folder_ + "/" + name, std::ios::binary);
        const std::string whole{std::istreambuf_iterator<char>(in), {}};
        for (std::size_t place = 0; place < whole.size(); ++place)
            for (const char bits : {'\x01', '\x20', '\x80'}) {
                std::string changed = whole;
                changed[place] = static_cast<char>(changed[place] ^ bits);
                write(name, changed);
                bool found = true;
                try {
                    found = !check_sums(folder_).empty();
                } catch (const UserError&) {
                    // Said in its own way.
                }
                EXPECT_TRUE(found) << name << ", byte " << place;
            }
        write(name, whole);
    }
    EXPECT_TRUE(check_sums(folder_).empty());
    write("sums.json", "{}\n\n");
    EXPECT_FALSE(check_sums(folder_).empty());
}

TEST_F(Sums, WhatIsMissingOrWasAddedIsFound) {
    fs::remove(folder_ + "/inputs.jsonl");
    write("more.txt", "");
    const auto found = check_sums(folder_);
    ASSERT_EQ(found.size(), 2U);
    EXPECT_NE(found[0].find("inputs.jsonl is missing"), std::string::npos);
    EXPECT_NE(found[1].find("more.txt was added"), std::string::npos);
}

TEST_F(Sums, ABrokenListIsNamed) {
    for (const char* bad : {"", "[]", "{"}) {
        write("sums.json", bad);
        EXPECT_THROW(check_sums(folder_), UserError) << bad;
    }
    write("sums.json", R"({"trace.csv": 3, "inputs.jsonl": null})");
    EXPECT_EQ(check_sums(folder_).size(), 2U);
    fs::remove(folder_ + "/sums.json");
    EXPECT_THROW(check_sums(folder_), UserError);
}

}  // namespace
}  // namespace cathlab
