#include "imaging/video_writer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>

#include "core/errors.h"
#include "imaging/film_codec.h"

namespace cathlab {
namespace {

namespace fs = std::filesystem;

Image8 moving_square(int width, int height, int step) {
    Image8 image(width, height, 40);
    paste(image, Image8(12, 12, 220), step, height / 2);
    return image;
}

class Video : public testing::Test {
protected:
    void SetUp() override {
        folder_ = fs::temp_directory_path() /
                  (std::string("cathlab_video_") + testing::UnitTest::GetInstance()->current_test_info()->name());
        fs::remove_all(folder_);
        fs::create_directories(folder_);
    }
    void TearDown() override { fs::remove_all(folder_); }
    std::string file(const char* name) const { return (folder_ / name).string(); }
    std::size_t files() const {
        return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder_), fs::directory_iterator{}));
    }
    fs::path folder_;
};

TEST_F(Video, ReadsBackWithItsFramesAndSize) {
    VideoWriter video(file("a.mp4"), 128, 64, 15.0);
    for (int i = 0; i < 20; ++i) video.add(moving_square(128, 64, 2 * i));
    EXPECT_FALSE(fs::exists(file("a.mp4")));
    video.close();
    const VideoFacts facts = read_video_facts(file("a.mp4"));
    EXPECT_EQ(facts.frames, 20U);
    EXPECT_EQ(facts.width, 128);
    EXPECT_EQ(facts.height, 64);
    EXPECT_NEAR(facts.fps, 15.0, 0.01);
    EXPECT_EQ(files(), 1U);
}

TEST_F(Video, AnAviKeepsEveryByte) {
    const Image8 frame = moving_square(64, 32, 9);
    VideoWriter video(file("a.avi"), 64, 32, 30.0);
    video.add(moving_square(64, 32, 0));
    video.add(frame);
    video.close();
    EXPECT_EQ(video.codec(), "FFV1");
    EXPECT_EQ(read_video_frame(file("a.avi"), 1).rgb, frame.rgb);
    EXPECT_THROW(read_video_frame(file("a.avi"), 2), UserError);
}

TEST_F(Video, TheSamePicturesGiveTheSameBytes) {
    for (const char* ending : {".mp4", ".avi"}) {
        std::array<std::string, 2> bytes;
        for (std::string& film : bytes) {
            const std::string path = (folder_ / "a").string() + ending;
            VideoWriter video(path, 128, 64, 15.0);
            for (int i = 0; i < 40; ++i) video.add(moving_square(128, 64, 2 * i));
            video.close();
            std::ifstream file(path, std::ios::binary);
            film.assign(std::istreambuf_iterator<char>(file), {});
        }
        EXPECT_GT(bytes[0].size(), 1000U);
        EXPECT_TRUE(bytes[0] == bytes[1]) << ending;
    }
}

TEST_F(Video, AFluoroscopysGreyStaysGreyAndAsBright) {
    VideoWriter video(file("a.mp4"), 128, 64, 15.0);
    Image8 ramp(128, 64);
    for (std::size_t i = 0; i < ramp.rgb.size(); ++i) ramp.rgb[i] = static_cast<std::uint8_t>(i / 3 % 128 * 2);
    for (int i = 0; i < 5; ++i) video.add(ramp);
    video.close();
    const Image8 seen = read_video_frame(file("a.mp4"), 2);
    for (std::size_t i = 0; i < seen.rgb.size(); ++i) EXPECT_NEAR(seen.rgb[i], ramp.rgb[i], 6) << i;
    double error = 0.0, cast = 0.0;
    for (std::size_t i = 0; i < seen.rgb.size(); i += 3) {
        error += std::abs(seen.rgb[i + 1] - ramp.rgb[i + 1]);
        cast += std::abs(seen.rgb[i] - seen.rgb[i + 2]);
    }
    EXPECT_LT(error / (128 * 64), 1.5);
    EXPECT_LT(cast / (128 * 64), 0.5);
}

TEST_F(Video, ATornFilmIsFoundOut) {
    for (const char* name : {"a.mp4", "a.avi"}) {
        VideoWriter video(file(name), 128, 64, 15.0);
        for (int i = 0; i < 40; ++i) video.add(moving_square(128, 64, 2 * i));
        video.close();
        fs::resize_file(file(name), fs::file_size(file(name)) * 2 / 3);
        std::size_t found = 0;
        try {
            found = read_video_facts(file(name)).frames;
        } catch (const UserError&) {
        }
        EXPECT_LT(found, 40U) << name;
    }
    EXPECT_THROW(read_video_facts(file("none.mp4")), UserError);
}

TEST_F(Video, GivenUpLeavesNothing) {
    auto video = std::make_unique<VideoWriter>(file("a.mp4"), 64, 32, 15.0);
    video->add(moving_square(64, 32, 0));
    video.reset();
    EXPECT_EQ(files(), 0U);
}

TEST_F(Video, WithoutAFrameIsAnErrorAndLeavesNothing) {
    VideoWriter video(file("a.mp4"), 64, 32, 15.0);
    EXPECT_THROW(video.close(), UserError);
    EXPECT_EQ(files(), 0U);
}

TEST_F(Video, ACodecThatIsNotThereIsToldWithThoseThatAre) {
    const auto fault = [&](const char* name, const char* codec) -> std::string {
        try {
            VideoWriter(file(name), 128, 64, 15.0, codec);
        } catch (const UserError& error) {
            return error.what();
        }
        return "";
    };
    EXPECT_NE(fault("a.mp4", "h265").find("there is no codec 'h265'; known are h264, mpeg4, ffv1"), std::string::npos)
        << fault("a.mp4", "h265");
    EXPECT_NE(fault("a.avi", "h264").find("goes into a file .mp4"), std::string::npos);
    EXPECT_NE(fault("a.mp4", "ffv1").find("goes into a file .avi"), std::string::npos);
    EXPECT_EQ(files(), 0U);
    VideoWriter part2(file("b.mp4"), 128, 64, 15.0, "mpeg4");
    EXPECT_EQ(part2.codec(), "mp4v");
    EXPECT_EQ(VideoWriter(file("c.avi"), 128, 64, 15.0, "ffv1").codec(), "FFV1");
}

// No machine that builds cathlab lacks an encoder, so the machine is made up.
TEST(FilmCodec, AKnownCodecWithoutAnEncoderIsToldWithThoseThatHaveOne) {
    const auto fault = [](const char* extension, const char* name, std::vector<FilmCodec> here) -> std::string {
        try {
            choose_codec("a.film", extension, name,
                         [&](FilmCodec codec) { return std::find(here.begin(), here.end(), codec) != here.end(); });
        } catch (const UserError& error) {
            return error.what();
        }
        return "";
    };
    EXPECT_EQ(fault(".mp4", "h264", {FilmCodec::mpeg4, FilmCodec::lossless}),
              "cannot write video 'a.film': this system has no encoder of h264; it has mpeg4, ffv1");
    EXPECT_EQ(fault(".avi", "ffv1", {FilmCodec::h264}),
              "cannot write video 'a.film': this system has no encoder of ffv1; it has h264");
    EXPECT_EQ(fault(".avi", "", {FilmCodec::h264}),
              "cannot write video 'a.film': this system has no encoder for .avi; it has h264");
    EXPECT_NE(fault(".mp4", "", {}).find("it has none that cathlab writes"), std::string::npos);
    EXPECT_EQ(fault(".mp4", "h264", {FilmCodec::h264}), "");
    // Without a name another codec of the same file will do.
    const auto only_part2 = [](FilmCodec codec) { return codec == FilmCodec::mpeg4; };
    EXPECT_EQ(choose_codec("a.mp4", ".mp4", "", only_part2), FilmCodec::mpeg4);
    EXPECT_EQ(choose_codec("a.mp4", ".mp4", "", [](FilmCodec) { return true; }), FilmCodec::h264);
}

TEST_F(Video, OddSizesUnknownEndingsAndMissingFoldersAreRefused) {
    EXPECT_THROW(VideoWriter(file("a.mp4"), 127, 64, 15.0), UserError);
    EXPECT_THROW(VideoWriter(file("a.mp4"), 128, 63, 15.0), UserError);
    EXPECT_THROW(VideoWriter(file("a.mp4"), 0, 64, 15.0), UserError);
    EXPECT_THROW(VideoWriter(file("a.gif"), 128, 64, 15.0), UserError);
    EXPECT_THROW(VideoWriter(file("a.mp4"), 128, 64, 0.0), UserError);
    EXPECT_THROW(VideoWriter(file("missing/a.mp4"), 128, 64, 15.0), UserError);
    EXPECT_THROW(VideoWriter("/proc/a.mp4", 128, 64, 15.0), UserError);
    EXPECT_THROW(VideoWriter("/dev/full/a.mp4", 128, 64, 15.0), UserError);
    EXPECT_EQ(files(), 0U);
}

}  // namespace
}  // namespace cathlab
