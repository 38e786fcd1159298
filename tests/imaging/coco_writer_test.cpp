#include "imaging/coco_writer.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>

#include "core/errors.h"

namespace cathlab {
namespace {

namespace fs = std::filesystem;

TEST(CocoMask, ComesBackPixelForPixelWhereverItIsPlaced) {
    std::vector<std::uint8_t> inside(40 * 30);
    for (int y = 0; y < 30; ++y) {
        for (int x = 0; x < 40; ++x)
            inside[static_cast<std::size_t>(y) * 40 + static_cast<std::size_t>(x)] = (x * x + 3 * y) % 7 < 3 ? 1 : 0;
    }
    for (const auto& [x0, y0] : {std::pair(0, 0), std::pair(24, 10), std::pair(-5, 20)}) {
        const CocoMask mask = coco_mask(inside, 40, 30, x0, y0, 64, 48);
        const std::vector<std::uint8_t> back = read_coco_mask(mask.counts, 64, 48);
        std::int64_t area = 0;
        for (int y = 0; y < 48; ++y) {
            for (int x = 0; x < 64; ++x) {
                const int u = x - x0, v = y - y0;
                const bool in = u >= 0 && u < 40 && v >= 0 && v < 30 &&
                                inside[static_cast<std::size_t>(v) * 40 + static_cast<std::size_t>(u)] != 0;
                ASSERT_EQ(back[static_cast<std::size_t>(y) * 64 + static_cast<std::size_t>(x)], in ? 1 : 0);
                area += in ? 1 : 0;
            }
        }
        EXPECT_EQ(mask.area, area);
    }
}

TEST(CocoMask, IsPackedAsCocosOwnToolsDo) {
    // Columns of a 3 x 2 picture: (0 1) (1 1) (0 0): runs 1 3 2, which are the characters '0' + run.
    const std::vector<std::uint8_t> inside = {0, 1, 0, 1, 1, 0};
    const CocoMask mask = coco_mask(inside, 3, 2, 0, 0, 3, 2);
    EXPECT_EQ(mask.counts, "132");
    EXPECT_EQ(mask.box, (std::array<int, 4>{0, 0, 2, 2}));
    // Nothing: one run of 40 x 30 zeros, 1200 = 16 + 5 * 32 + 1 * 1024: 'P' (16 and more), 'U' (5 and more), '1'.
    EXPECT_EQ(coco_mask(std::vector<std::uint8_t>(1200), 40, 30, 0, 0, 40, 30).counts, "`U1");
}

TEST(CocoWriter, AFileIsWholeOrNotThere) {
    const fs::path path = fs::temp_directory_path() / ("cathlab_labels_test_" + std::to_string(getpid()) + ".json");
    fs::remove(path);
    {
        CocoWriter given_up(path.string(), "x", {{"wire", "device"}}, {});
        given_up.add({"a.png", 4, 4, ""}, {}, {});
    }
    EXPECT_FALSE(fs::exists(path));
    EXPECT_FALSE(fs::exists(path.string() + ".part"));
    CocoWriter writer(path.string(), "x", {{"wire", "device"}}, {"wire_tip"});
    const std::vector<std::uint8_t> inside(16, 1);
    writer.add({"a.png", 4, 4, R"({"time_s": 1.5})"},
               {{"wire", coco_mask(inside, 4, 4, 0, 0, 4, 4), R"({"more": [1]})"}}, {{1.25, 2.5, 2}});
    writer.close();
    std::ifstream file(path);
    const std::string text(std::istreambuf_iterator<char>(file), {});
    for (const char* part : {R"("num_keypoints":1)", R"("keypoints":[1.25,2.5,2])", R"("time_s":1.5)", R"("more":[1])",
                             R"("bbox":[0,0,4,4],"area":16)", R"("name":"wire","supercategory":"device")"})
        EXPECT_NE(text.find(part), std::string::npos) << part << text;
    fs::remove(path);
    EXPECT_THROW(CocoWriter("/nonexistent/x.json", "", {}, {}), UserError);
}

}  // namespace
}  // namespace cathlab
