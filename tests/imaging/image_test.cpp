#include "imaging/image.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>

#include "core/errors.h"

namespace cathlab {
namespace {

namespace fs = std::filesystem;

Image8 ramp(int width, int height) {
    Image8 image(width, height);
    for (std::size_t i = 0; i < image.rgb.size(); ++i) image.rgb[i] = static_cast<std::uint8_t>((i * 7) % 251);
    return image;
}

TEST(Png, APictureComesBackByteForByte) {
    const fs::path path = fs::temp_directory_path() / ("cathlab_image_test_" + std::to_string(getpid()) + ".png");
    const Image8 image = ramp(37, 21);
    write_png(path.string(), image);
    const Image8 back = read_png(path.string());
    EXPECT_EQ(back.width, 37);
    EXPECT_EQ(back.height, 21);
    EXPECT_EQ(back.rgb, image.rgb);
    EXPECT_FALSE(fs::exists(path.string() + ".part"));
    fs::remove(path);
}

TEST(Png, AMissingFolderIsTheUsersMistake) {
    EXPECT_THROW(write_png("/nonexistent/folder/x.png", ramp(4, 4)), UserError);
    EXPECT_THROW(read_png("/nonexistent/folder/x.png"), UserError);
}

TEST(Png, ATextFileIsNotAPicture) {
    EXPECT_THROW(read_png(std::string(CATHLAB_SOURCE_DIR) + "/CMakeLists.txt"), UserError);
}

TEST(Paste, WhatLiesOutsideIsLeftAway) {
    Image8 whole(10, 10);
    paste(whole, Image8(6, 6, 200), 7, -3);
    EXPECT_EQ(whole.rgb[whole.offset(7, 0)], 200);
    EXPECT_EQ(whole.rgb[whole.offset(9, 2)], 200);
    EXPECT_EQ(whole.rgb[whole.offset(6, 0)], 0);
    EXPECT_EQ(whole.rgb[whole.offset(9, 3)], 0);
}

TEST(Resized, AFlatPictureStaysFlat) {
    const Image8 small = resized(Image8(64, 48, 90), 16, 12);
    EXPECT_EQ(small.width, 16);
    EXPECT_EQ(small.rgb, Image8(16, 12, 90).rgb);
}

}  // namespace
}  // namespace cathlab
