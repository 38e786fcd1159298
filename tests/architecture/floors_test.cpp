// docs/architecture.md against the build: the same rooms, floors, uses and packages.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

#include "architecture/text.h"

namespace {

struct Row {
    std::string floor;
    std::set<std::string> uses, packages;
};

std::set<std::string> words(const std::string& text) {
    std::set<std::string> out;
    for (const std::string& word : architecture::split(text, ' '))
        if (!word.empty()) out.insert(word);
    return out;
}

// "| floor | room | what | uses | packages |" rows of the table of floors.
std::map<std::string, Row> documented() {
    std::map<std::string, Row> out;
    for (const std::string& line : architecture::read_lines(CATHLAB_SOURCE_DIR "/docs/architecture.md")) {
        const auto cells = architecture::split(line, '|');
        if (cells.size() < 6 || cells[1].empty() || cells[1].find_first_not_of("0123456789") != std::string::npos)
            continue;
        EXPECT_TRUE(out.emplace(cells[2], Row{cells[1], words(cells[4]), words(cells[5])}).second)
            << "room '" << cells[2] << "' stands twice";
    }
    return out;
}

// "room|floor|uses|packages" lines that CMake wrote from what the rooms declared.
std::map<std::string, Row> built() {
    std::map<std::string, Row> out;
    for (const std::string& line : architecture::read_lines(CATHLAB_ROOMS_FILE)) {
        auto cells = architecture::split(line, '|');
        cells.resize(4);
        out[cells[0]] = Row{cells[1], words(cells[2]), words(cells[3])};
    }
    return out;
}

}  // namespace

TEST(Floors, TheDocumentNamesTheRoomsOfTheBuildAndNoOther) {
    const auto document = documented();
    const auto build = built();
    ASSERT_FALSE(build.empty());
    for (const auto& [room, row] : build) EXPECT_TRUE(document.count(room)) << "'" << room << "' is not documented";
    for (const auto& [room, row] : document) EXPECT_TRUE(build.count(room)) << "'" << room << "' is not in the build";
}

TEST(Floors, FloorUsesAndPackagesAreThoseOfTheBuild) {
    const auto document = documented();
    for (const auto& [room, row] : built()) {
        const auto it = document.find(room);
        if (it == document.end()) continue;  // named by the test above
        EXPECT_EQ(it->second.floor, row.floor) << room;
        EXPECT_EQ(it->second.packages, row.packages) << room;
        if (room != "app") {
            EXPECT_EQ(it->second.uses, row.uses) << room;
        }
    }
}

TEST(Floors, ARoomStandsAboveEveryRoomThatItUses) {
    const auto build = built();
    for (const auto& [room, row] : build)
        for (const std::string& used : row.uses) {
            ASSERT_TRUE(build.count(used)) << room << " uses " << used;
            EXPECT_GT(std::stoi(row.floor), std::stoi(build.at(used).floor)) << room << " uses " << used;
        }
}
