#include "imaging/dicom_writer.h"

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <vector>

#include "core/errors.h"

namespace cathlab {
namespace {

namespace fs = std::filesystem;

std::string written(const fs::path& path, bool turning) {
    DicomFacts facts;
    facts.description = "test";
    facts.software = "cathlab test";
    DicomWriter writer(path.string(), facts, 33, 17);  // an odd number of bytes
    for (int k = 0; k < 3; ++k) {
        std::vector<std::uint8_t> grey(33 * 17);
        for (std::size_t i = 0; i < grey.size(); ++i)
            grey[i] = static_cast<std::uint8_t>((i * 7 + static_cast<std::size_t>(k)) % 251);
        writer.add(grey, {30.0 + (turning ? 2.5 * k : 0.0), -10.0, 79.6, 0.5 * k, 1.0, 0.2});
    }
    writer.close();
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

class Dicom : public testing::Test {
protected:
    void TearDown() override { fs::remove(path_); }
    fs::path path_ = fs::temp_directory_path() /
                     (std::string("cathlab_") + testing::UnitTest::GetInstance()->current_test_info()->name() + ".dcm");
};

TEST_F(Dicom, TheSameFramesGiveTheSameBytesAndOthersAnotherIdentity) {
    const std::string once = written(path_, false), again = written(path_, false), other = written(path_, true);
    EXPECT_TRUE(once == again);
    EXPECT_FALSE(once == other);
    EXPECT_EQ(once.substr(128, 4), "DICM");
    EXPECT_NE(once.find("SIM^PHANTOM"), std::string::npos);
    EXPECT_NE(once.find("STATIC"), std::string::npos);
    EXPECT_NE(other.find("DYNAMIC"), std::string::npos);
    EXPECT_NE(other.find("0\\2.5\\5"), std::string::npos);
    EXPECT_FALSE(fs::exists(path_.string() + ".part"));
}

TEST_F(Dicom, TheValidatorFindsNoError) {
    if (std::system("command -v dciodvfy >/dev/null 2>&1") != 0)
        GTEST_SKIP() << "dciodvfy (dicom3tools) is not installed";
    for (const bool turning : {false, true}) {
        written(path_, turning);
        FILE* pipe = ::popen(("dciodvfy " + path_.string() + " 2>&1").c_str(), "r");
        std::string said;
        std::array<char, 4096> buffer{};
        while (const std::size_t n = std::fread(buffer.data(), 1, buffer.size(), pipe)) said.append(buffer.data(), n);
        const int status = ::pclose(pipe);
        EXPECT_EQ(WEXITSTATUS(status), 0) << said;
        EXPECT_EQ(said.find("Error"), std::string::npos) << said;
        EXPECT_NE(said.find("XAImage"), std::string::npos) << said;
    }
}

TEST_F(Dicom, AFolderThatIsNotThereAndAFilmWithoutAFrameAreRefused) {
    EXPECT_THROW(DicomWriter("/nonexistent/x.dcm", {}, 8, 8), UserError);
    {
        DicomWriter empty(path_.string(), {}, 8, 8);
        EXPECT_THROW(empty.close(), UserError);
    }
    EXPECT_FALSE(fs::exists(path_));
    EXPECT_FALSE(fs::exists(path_.string() + ".part"));
}

}  // namespace
}  // namespace cathlab
