// What moves in a picture, written and read back; and files that were cut, changed or made up.
#include "record/poses.h"

#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>

#include "core/errors.h"
#include "core/hash.h"
#include "scene/temporary_folder.h"

namespace cathlab {
namespace {

std::vector<Vec3> rest_of(std::size_t n) {
    std::vector<Vec3> out;
    for (std::size_t i = 0; i < n; ++i) out.emplace_back(0.3 * static_cast<double>(i), -120.0, 400.0);
    return out;
}

ScenePoses poses_of(const std::vector<Vec3>& rest, double by_mm) {
    ScenePoses p;
    p.lumen = rest;
    for (std::size_t i = 10; i < 40; ++i) p.lumen[i] += Vec3(by_mm, 0.5 * by_mm, -by_mm);
    p.lumen[60] += Vec3(0.0, 0.0, 11.25);
    p.wall_force_n = {{3, 0.25}, {17, 0.5}};
    p.contrast_mg_ml = {0.0, 350.0, 12.5};
    DevicePose wire;
    wire.name = "wire";
    wire.points = {Vec3(1, 2, 3), Vec3(4, 5, 6), Vec3(7, 8, 9.125)};
    wire.radius_mm = {0.25, 0.5};
    wire.material_of = {wire.material_index("platinum"), wire.material_index("stainless_steel")};
    DevicePose catheter;
    catheter.name = "catheter";
    catheter.points = {Vec3(1, 2, 3), Vec3(4, 5, 6)};
    catheter.radius_mm = {1.0};
    catheter.inner_radius_mm = {0.75};
    catheter.material_of = {catheter.material_index("pebax")};
    p.devices = {catheter, wire};
    p.tip = ScenePoses::Tip{Vec3(1, 2, 3), Vec3(0, 0.6, 0.8)};
    return p;
}

class Poses : public testing::Test {
protected:
    Poses() { std::filesystem::create_directories(folder_); }
    void write() {
        PosesWriter writer(folder_, frame_, 15.0);
        writer.add(0, poses_of(rest_, 1.0));
        writer.add(3, poses_of(rest_, 2.0));
        writer.add(6, poses_of(rest_, 3.0));
        writer.close();
    }
    std::string bytes() const {
        std::ifstream in(path_, std::ios::binary);
        return {std::istreambuf_iterator<char>(in), {}};
    }
    void put(const std::string& bytes) const { std::ofstream(path_, std::ios::binary) << bytes; }
    // "" or the sentence of the error, which must name the file.
    std::string fault(bool complete = true) const {
        try {
            PosesReader reader(folder_, frame_, complete);
            for (std::int64_t k = 0; k < 10; ++k) reader.at(k);
        } catch (const UserError& error) {
            const std::string text = error.what();
            EXPECT_EQ(text.rfind(path_ + ": ", 0), 0U) << text;
            EXPECT_EQ(text.find('\n'), std::string::npos);
            return text;
        }
        return "";
    }

    TemporaryFolder temporary_;
    std::string folder_ = temporary_.path("run");
    std::string path_ = folder_ + "/poses.bin";
    std::vector<Vec3> rest_ = rest_of(100);
    PosesFrame frame_{&rest_, 3, 0x1234};
};

TEST_F(Poses, ComeBackAsTheyStood) {
    write();
    PosesReader reader(folder_, frame_, true);
    EXPECT_EQ(reader.rate_hz(), 15.0);
    double by_mm = 0.0;
    for (const std::int64_t step : {0, 2, 3, 5, 6, 9}) {
        by_mm = step < 3 ? 1.0 : step < 6 ? 2.0 : 3.0;
        const ScenePoses& p = reader.at(step);
        const ScenePoses truth = poses_of(rest_, by_mm);
        ASSERT_EQ(p.lumen.size(), rest_.size());
        for (std::size_t i = 0; i < rest_.size(); ++i) EXPECT_LT((p.lumen[i] - truth.lumen[i]).norm(), 0.002);
        EXPECT_EQ(p.lumen[5], rest_[5]);
        EXPECT_EQ(p.wall_force_n, truth.wall_force_n);
        EXPECT_EQ(p.contrast_mg_ml, truth.contrast_mg_ml);
        ASSERT_EQ(p.devices.size(), 2U);
        for (std::size_t d = 0; d < 2; ++d) {
            EXPECT_EQ(p.devices[d].name, truth.devices[d].name);
            EXPECT_EQ(p.devices[d].points, truth.devices[d].points);
            EXPECT_EQ(p.devices[d].radius_mm, truth.devices[d].radius_mm);
            EXPECT_EQ(p.devices[d].inner_radius_mm, truth.devices[d].inner_radius_mm);
            EXPECT_EQ(p.devices[d].materials, truth.devices[d].materials);
            EXPECT_EQ(p.devices[d].material_of, truth.devices[d].material_of);
        }
        ASSERT_TRUE(p.tip.has_value());
        EXPECT_LT((p.tip->forward - truth.tip->forward).norm(), 1e-6);
    }
    EXPECT_EQ(by_mm, 3.0);
}

TEST_F(Poses, AreDueAsAFilmsPicturesAre) {
    PosesWriter writer(folder_, frame_, 15.0);
    std::vector<int> steps;
    for (int k = 0; k < 12; ++k) {
        if (!writer.due(0.02 * (k + 1))) continue;
        writer.add(k, poses_of(rest_, 1.0));
        steps.push_back(k);
    }
    EXPECT_EQ(steps, (std::vector<int>{0, 3, 6, 9}));
}

TEST_F(Poses, AChangedByteIsFoundOut) {
    write();
    const std::string good = bytes();
    ASSERT_EQ(fault(), "");
    for (std::size_t i = 0; i < good.size(); i += 5) {
        std::string bad = good;
        bad[i] = static_cast<char>(bad[i] ^ 0x10);
        put(bad);
        ASSERT_NE(fault(), "") << "byte " << i;
    }
}

TEST_F(Poses, AFileThatWasCutIsToldOfAClosedRunAndReadAsFarAsItGoesOfABrokenOne) {
    write();
    const std::string good = bytes();
    PosesReader reader(folder_, frame_, true);
    for (std::size_t n = 0; n < good.size(); n += 7) {
        put(good.substr(0, n));
        ASSERT_NE(fault(), "") << "cut to " << n;
    }
    put(good.substr(0, good.size() - 100));  // the end, and a part of the last record
    EXPECT_NE(fault().find("truncated?"), std::string::npos) << fault();
    EXPECT_EQ(fault(false), "");
    PosesReader broken(folder_, frame_, false);
    EXPECT_LT((broken.at(9).lumen[10] - poses_of(rest_, 2.0).lumen[10]).norm(), 0.002);
    put(good + "x");
    EXPECT_NE(fault().find("goes on after its end"), std::string::npos);
}

TEST_F(Poses, AnotherAnatomyOrVersionIsTold) {
    write();
    PosesFrame other = frame_;
    other.anatomy_hash = 1;
    EXPECT_THROW(PosesReader(folder_, other, true), UserError);
    other = frame_;
    other.nodes = 4;
    EXPECT_THROW(PosesReader(folder_, other, true), UserError);
    std::string newer = bytes();
    newer[16] = 2;
    put(newer);
    EXPECT_NE(fault().find("is of version 2, this program reads 1"), std::string::npos) << fault();
    put("PNG");
    EXPECT_NE(fault().find("is no file of poses"), std::string::npos) << fault();
    std::filesystem::remove(path_);
    EXPECT_NE(fault().find("cannot be read"), std::string::npos) << fault();
}

// Records whose sums fit and whose numbers cannot be: made by somebody, not by a disk.
TEST_F(Poses, AMadeUpRecordIsRefused) {
    write();
    const std::string good = bytes();
    constexpr std::size_t head = 56, record = head + 24;
    std::uint64_t size = 0;
    std::memcpy(&size, good.data() + head + 8, sizeof size);
    const auto forged = [&](std::size_t at, const auto& value) {
        std::string bad = good;
        std::memcpy(bad.data() + record + at, &value, sizeof value);
        std::uint64_t step = 0;
        Hash64 hash;
        hash.word(step);
        hash.word(size);
        hash.bytes(bad.data() + record, size);
        const std::uint64_t sum = hash.value();
        std::memcpy(bad.data() + head + 16, &sum, sizeof sum);
        put(bad);
        return fault();
    };
    EXPECT_EQ(forged(0, std::uint8_t{1}), "");  // as it was
    EXPECT_NE(forged(1, std::numeric_limits<float>::quiet_NaN()).find("not finite"), std::string::npos);
    EXPECT_NE(forged(13, 7.0F).find("direction"), std::string::npos);
    EXPECT_NE(forged(25, std::uint32_t{0xFFFFFFFF}).find("names more than it holds"), std::string::npos);
    for (std::size_t at = 25; at + 4 <= size; ++at)  // wherever it stands, a huge number harms nobody
        forged(at, std::uint32_t{0x7FFFFFF0});
    const std::uint64_t huge = 1ULL << 60U;
    std::string bad = good;
    std::memcpy(bad.data() + head + 8, &huge, sizeof huge);
    put(bad);
    EXPECT_NE(fault().find("larger than a record can be"), std::string::npos);
}

}  // namespace
}  // namespace cathlab
