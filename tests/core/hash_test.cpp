#include "core/hash.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <bit>
#include <filesystem>
#include <fstream>
#include <set>

#include "core/errors.h"

using namespace cathlab;

namespace {

std::uint64_t hash_of(std::string_view text) {
    Hash64 hash;
    hash.text(text);
    return hash.value();
}

struct State {
    double a = 1.0;
    std::vector<Vec3> points{{1.0, 2.0, 3.0}, {4.0, 5.0, 6.0}};
    bool on = true;
    Index count = 3;
    Pose pose;
};

std::uint64_t hash_of(State state) {
    HashArchive archive;
    archive.field("a", state.a);
    archive.field("points", state.points);
    archive.field("on", state.on);
    archive.field("count", state.count);
    archive.field("pose", state.pose);
    return archive.value();
}

}  // namespace

TEST(Hash, IsTheSameNumberOnEveryMachine) {
    EXPECT_EQ(hash_text(hash_of("")), "c385fb0a5b698a7d");
    EXPECT_EQ(hash_text(hash_of("guidewire")), "bcfbbd547f08f05f");
    EXPECT_EQ(hash_text(hash_of(State{})), "69c3e8df8e047e95");
}

TEST(Hash, TextIsSixteenDigitsWithLeadingZeros) {
    EXPECT_EQ(hash_text(0), "0000000000000000");
    EXPECT_EQ(hash_text(0x0123456789ABCDEFULL), "0123456789abcdef");
}

TEST(Hash, EveryFieldAndEveryBitCounts) {
    const std::uint64_t before = hash_of(State{});
    State state;
    state.a = std::bit_cast<double>(std::bit_cast<std::uint64_t>(state.a) ^ 1U);
    EXPECT_NE(hash_of(state), before);
    state = {};
    state.points[1].y() = -5.0;
    EXPECT_NE(hash_of(state), before);
    state = {};
    state.on = false;
    EXPECT_NE(hash_of(state), before);
    state = {};
    state.count = 4;
    EXPECT_NE(hash_of(state), before);
    state = {};
    state.pose.orientation = Quat(0.0, 1.0, 0.0, 0.0);
    EXPECT_NE(hash_of(state), before);
    state = {};
    state.a = 0.0;
    const std::uint64_t zero = hash_of(state);
    state.a = -0.0;
    EXPECT_NE(hash_of(state), zero);
}

TEST(Hash, WhereOneArrayEndsAndTheNextBeginsCounts) {
    const auto pair = [](std::vector<double> a, std::vector<double> b) {
        HashArchive archive;
        archive.field("a", a);
        archive.field("b", b);
        return archive.value();
    };
    EXPECT_NE(pair({1.0, 2.0}, {3.0}), pair({1.0}, {2.0, 3.0}));
    EXPECT_NE(pair({}, {0.0}), pair({0.0}, {}));
}

TEST(Hash, ShortTextsDoNotCollide) {
    std::set<std::uint64_t> seen;
    int count = 0;
    for (char a = 'a'; a <= 'z'; ++a)
        for (char b = 'a'; b <= 'z'; ++b)
            for (char c = 'a'; c <= 'z'; ++c, ++count) seen.insert(hash_of(std::string{a, b, c}));
    EXPECT_EQ(seen.size(), static_cast<std::size_t>(count));
}

TEST(Hash, AFilesHashIsOfItsBytesAndAMissingFileIsTheUsersError) {
    const auto path = std::filesystem::temp_directory_path() / ("cathlab_hash_" + std::to_string(getpid()));
    std::ofstream(path) << std::string(200000, 'x');
    const std::uint64_t first = hash_file(path.string());
    std::ofstream(path) << std::string(199999, 'x') << 'y';
    EXPECT_NE(hash_file(path.string()), first);
    std::filesystem::remove(path);
    EXPECT_THROW(hash_file(path.string()), UserError);
}
