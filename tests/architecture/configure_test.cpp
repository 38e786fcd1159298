// A small house with its own rooms, configured by the project's engine/rooms.cmake: a sound one passes, a broken one
// stops.
#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <cstdio>

#include "architecture/text.h"

namespace {

namespace fs = std::filesystem;

class Configure : public testing::Test {
protected:
    void SetUp() override {
        const std::string name = testing::UnitTest::GetInstance()->current_test_info()->name();
        root_ = fs::temp_directory_path() / ("cathlab_configure_" + name + std::to_string(getpid()));
        write("CMakeLists.txt", R"(cmake_minimum_required(VERSION 3.25)
project(fixture LANGUAGES CXX)
add_library(Eigen3::Eigen INTERFACE IMPORTED)
add_library(cathlab_options INTERFACE)
add_library(cathlab_package_guest INTERFACE)
set(CATHLAB_PACKAGES guest CACHE INTERNAL "")
set(CATHLAB_HEADERS_guest guest CACHE INTERNAL "")
include(")" CATHLAB_SOURCE_DIR R"(/engine/rooms.cmake")
foreach(room cellar garden attic)
  add_subdirectory(engine/${room})
endforeach()
)");
        write("engine/cellar/CMakeLists.txt", "cathlab_room(cellar FLOOR 0 PACKAGES guest)\n");
        write("engine/cellar/cellar.h", "#pragma once\n");
        write("engine/cellar/cellar.cpp", "#include \"cellar/cellar.h\"\n#include <guest/guest.h>\n");
        write("engine/garden/CMakeLists.txt", "cathlab_room(garden FLOOR 1 USES cellar)\n");
        write("engine/garden/garden.h", "#pragma once\n");
        write("engine/garden/garden.cpp", "#include \"cellar/cellar.h\"\n#include <vector>\n");
        write("engine/attic/CMakeLists.txt", "cathlab_room(attic FLOOR 1 USES cellar)\n");
        write("engine/attic/attic.cpp", "#include \"cellar/cellar.h\"\n");
    }
    void TearDown() override { fs::remove_all(root_); }

    void write(const std::string& name, const std::string& text) const {
        fs::create_directories((root_ / name).parent_path());
        std::ofstream(root_ / name) << text;
    }

    /// Everything that cmake said; its exit code in status_.
    std::string configure() {
        const std::string command = std::string(CATHLAB_CMAKE) + " -G '" + CATHLAB_GENERATOR +
                                    "' -DCMAKE_CXX_COMPILER_WORKS=1 -S " + root_.string() + " -B " +
                                    (root_ / "build").string() + " 2>&1";
        std::string said;
        FILE* pipe = popen(command.c_str(), "r");
        if (pipe == nullptr) return "cmake could not be started";
        std::array<char, 4096> buffer{};
        while (const std::size_t got = fread(buffer.data(), 1, buffer.size(), pipe)) said.append(buffer.data(), got);
        status_ = pclose(pipe);
        return said;
    }

    fs::path root_;
    int status_ = -1;
};

}  // namespace

TEST_F(Configure, ASoundHousePasses) {
    const std::string said = configure();
    EXPECT_EQ(status_, 0) << said;
}

TEST_F(Configure, StopsWhereARoomIncludesARoomThatItDoesNotName) {
    write("engine/attic/attic.cpp", "#include \"garden/garden.h\"\n");
    const std::string said = configure();
    EXPECT_NE(status_, 0);
    EXPECT_NE(said.find("room 'attic' may not use 'garden'"), std::string::npos) << said;
}

TEST_F(Configure, StopsWhereARoomNamesARoomOfItsOwnFloor) {
    write("engine/attic/CMakeLists.txt", "cathlab_room(attic FLOOR 1 USES cellar garden)\n");
    const std::string said = configure();
    EXPECT_NE(status_, 0);
    EXPECT_NE(said.find("room 'attic' (floor 1) may not use 'garden' (floor 1)"), std::string::npos) << said;
}

TEST_F(Configure, StopsWhereARoomReachesForAPackageThatItDoesNotName) {
    write("engine/garden/garden.h", "#pragma once\n  #  include <guest/guest.h>\n");
    const std::string said = configure();
    EXPECT_NE(status_, 0);
    EXPECT_NE(said.find("room 'garden' may not use the package 'guest'"), std::string::npos) << said;
}
