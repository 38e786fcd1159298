// cathlab render: pictures of a recorded run from its poses, and by stepping it again.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <vector>

#include "app/program.h"
#include "scene/temporary_folder.h"

namespace cathlab {
namespace {

namespace fs = std::filesystem;

std::string bytes_of(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

std::vector<float> floats_of(const std::string& path) {
    const std::string bytes = bytes_of(path);
    std::vector<float> out(bytes.size() / sizeof(float));
    std::memcpy(out.data(), bytes.data(), out.size() * sizeof(float));
    return out;
}

class Render : public testing::Test {
protected:
    Outcome run(const std::string& more) {
        return call("run " + scene_ + " --seconds 1 --size 256x128 --threads 2 --out " + run_ + " " + more);
    }
    Outcome render(const std::string& out, const std::string& more) {
        return call("render " + run_ + " --threads 2 --size 256x128 --out " + folder_.path(out) + " " + more);
    }

    TemporaryFolder folder_;
    std::string scene_ = std::string(CATHLAB_SOURCE_DIR) + "/scenes/rigs/fork.toml";
    std::string run_ = folder_.path("run");
};

// The numbers of two JSON values differ by no more than that, and nothing else does.
void expect_near(const nlohmann::json& a, const nlohmann::json& b, double tolerance, const std::string& where) {
    if (a.is_number() && b.is_number()) {
        EXPECT_NEAR(a.get<double>(), b.get<double>(), tolerance) << where;
    } else if (a.is_structured() && a.type() == b.type() && a.size() == b.size()) {
        for (auto i = a.begin(), j = b.begin(); i != a.end(); ++i, ++j) expect_near(*i, *j, tolerance, where);
    } else {
        EXPECT_EQ(a, b) << where;
    }
}

TEST_F(Render, APictureFromThePosesIsThePictureOfTheStep) {
    ASSERT_EQ(run("").code, 0);
    ASSERT_TRUE(fs::exists(run_ + "/poses.bin"));
    const std::string wanted = "--video none --primary 30 --beam-on --labels coco --frame-format float --dicom ";
    const Outcome poses =
        render("poses", wanted + folder_.path("poses.dcm") + " --frames " + folder_.path("poses/frames"));
    ASSERT_EQ(poses.code, 0) << poses.text;
    EXPECT_NE(poses.text.find("from its poses"), std::string::npos) << poses.text;
    EXPECT_EQ(poses.text.find("replaying"), std::string::npos) << poses.text;
    const Outcome steps =
        render("steps", wanted + folder_.path("steps.dcm") + " --simulate --frames " + folder_.path("steps/frames"));
    ASSERT_EQ(steps.code, 0) << steps.text;
    std::size_t pictures = 0, changed = 0, pixels = 0;
    for (const auto& entry : fs::directory_iterator(folder_.path("steps/frames"))) {
        const auto a = floats_of(folder_.path("poses/frames/" + entry.path().filename().string()));
        const auto b = floats_of(entry.path().string());
        ASSERT_EQ(a.size(), 128U * 128U);
        ASSERT_EQ(a.size(), b.size());
        for (std::size_t i = 0; i < a.size(); ++i) {
            pixels += 1;
            changed += std::fabs(a[i] - b[i]) > 0.01F * b[i] + 0.05F ? 1 : 0;
        }
        ++pictures;
    }
    EXPECT_EQ(pictures, 16U);
    // The same quanta fall on the same pixels.
    EXPECT_LE(changed, pixels / 10000) << changed << " of " << pixels;
    expect_near(nlohmann::json::parse(bytes_of(folder_.path("poses/labels.json")))["images"],
                nlohmann::json::parse(bytes_of(folder_.path("steps/labels.json")))["images"], 0.002, "images");
    EXPECT_EQ(fs::file_size(folder_.path("poses.dcm")), fs::file_size(folder_.path("steps.dcm")));
}

TEST_F(Render, WhatNoPictureCanBeMadeOfIsToldBeforeTheFirst) {
    ASSERT_EQ(run("--video none --poses 15").code, 0);
    const std::string film = folder_.path("film/fluoro.mp4");
    const std::vector<std::pair<std::string, std::string>> wrong{
        {"--sid 900 --sod 950", "sod_mm: found 950"},
        {"--field-of-view 0", "--field-of-view"},
        {"--primary 200", "--primary"},
        {"--sid nan", "sid"},
        {"--isocentre 0 -1500 0 --primary 0 --beam-on", "behind the X-ray source"},
        {"--codec h265", "there is no codec 'h265'; known are h264, mpeg4, ffv1"},
        {"--codec ffv1", "goes into a file .avi"},
        {"--detector film", "--detector"},
        {"--view sideways", "--view"},
        {"--video /dev/full/film.mp4", "/dev/full"},
    };
    for (const auto& [options, sentence] : wrong) {
        const Outcome outcome = render("film", options);
        EXPECT_NE(outcome.code, 0) << options;
        EXPECT_NE(outcome.text.find(sentence), std::string::npos) << options << ": " << outcome.text;
        EXPECT_TRUE(fs::is_empty(folder_.path("film"))) << options;
        fs::remove_all(folder_.path("film"));
        fs::create_directory(folder_.path("film"));
    }
    EXPECT_EQ(call("render " + run_ + " --size 511x512 --out " + folder_.path("film")).code, 2);
}

// All of the demo: `cathlab run scenes/demo.toml --out DIR`, then the render of below with --fps 15.
TEST_F(Render, EveryRayOfTheDemoLeavesWhatItEnters) {
    scene_ = std::string(CATHLAB_SOURCE_DIR) + "/scenes/demo.toml";
    ASSERT_EQ(call("run " + scene_ + " --seconds 5 --video none --poses 2 --threads 2 --out " + run_).code, 0);
    for (const char* angles : {"", " --primary 40 --secondary -30"}) {
        const Outcome seen = call("render " + run_ + " --video none --still " + folder_.path("a.png") +
                                  " --beam-on --fps 2 --size 512x512 --fluoroscopy-alone" + angles);
        EXPECT_EQ(seen.code, 0) << seen.text;
        EXPECT_NE(seen.text.find("11 pictures of 250 steps"), std::string::npos) << seen.text;
        EXPECT_NE(seen.text.find("11 exposed, open surfaces met in 0"), std::string::npos) << seen.text;
    }
}

TEST_F(Render, WithoutPosesTheRunIsSteppedAgainAndASentenceSaysSo) {
    ASSERT_EQ(run("--video none").code, 0);
    EXPECT_FALSE(fs::exists(run_ + "/poses.bin"));
    const Outcome stepped = render("film", "--video none --still " + folder_.path("a.png"));
    EXPECT_EQ(stepped.code, 0) << stepped.text;
    EXPECT_NE(stepped.text.find("has no poses.bin, so the run is stepped again"), std::string::npos) << stepped.text;
}

TEST_F(Render, PosesCanBeAskedForWithoutAFilmAndLeftOutWithOne) {
    ASSERT_EQ(run("--video none --poses 5").code, 0);
    EXPECT_TRUE(fs::exists(run_ + "/poses.bin"));
    const Outcome coarse = render("film", "--still " + folder_.path("a.png"));
    EXPECT_EQ(coarse.code, 0) << coarse.text;
    EXPECT_NE(coarse.text.find("has poses of 5 instants a second"), std::string::npos) << coarse.text;
    ASSERT_EQ(run("--force --poses 0").code, 0);
    EXPECT_FALSE(fs::exists(run_ + "/poses.bin"));
    EXPECT_EQ(run("--force --poses -1").code, 2);
    EXPECT_EQ(run("--force --poses nan").code, 2);
}

TEST_F(Render, PosesThatWereChangedAreOneSentenceForRenderAndForScore) {
    ASSERT_EQ(run("--poses 15").code, 0);
    const std::string good = bytes_of(run_ + "/poses.bin");
    std::string bad = good;
    bad[bad.size() / 2] = static_cast<char>(bad[bad.size() / 2] ^ 1);
    folder_.write("run/poses.bin", bad);
    const Outcome changed = render("film", "");
    EXPECT_EQ(changed.code, 1);
    EXPECT_NE(changed.text.find("poses.bin: record"), std::string::npos) << changed.text;
    EXPECT_FALSE(fs::exists(folder_.path("film/fluoro.mp4")));
    const Outcome score = call("score " + run_);
    EXPECT_EQ(score.code, 1);
    EXPECT_NE(score.text.find("poses.bin was changed"), std::string::npos) << score.text;
    folder_.write("run/poses.bin", good.substr(0, good.size() / 2));
    const Outcome cut = render("film", "");
    EXPECT_EQ(cut.code, 1);
    EXPECT_NE(cut.text.find("truncated?"), std::string::npos) << cut.text;
    EXPECT_EQ(render("film", "--simulate").code, 0);
}

}  // namespace
}  // namespace cathlab
