// Headers of guests (Bullet, OpenCV, ...) stay where no other room can see them; Eigen is the exception.  What else no
// file of the engine may do.
#include <gtest/gtest.h>

#include <map>
#include <regex>
#include <set>

#include "architecture/text.h"

namespace {

namespace fs = std::filesystem;
const fs::path engine = fs::path(CATHLAB_SOURCE_DIR) / "engine";

struct Includes {
    std::vector<std::string> own;     // "room/file.h"
    std::vector<std::string> guests;  // <package/file.h>
};

Includes includes_of(const fs::path& file) {
    static const std::regex pattern(R"(^\s*#\s*include\s*([<"])([^>"]+)[>"])");
    Includes out;
    std::smatch match;
    for (const std::string& line : architecture::read_lines(file)) {
        if (!std::regex_search(line, match, pattern)) continue;
        const std::string header = match[2];
        const bool standard = header.find('/') == std::string::npos && header.find('.') == std::string::npos;
        if (match[1] == "\"")
            out.own.push_back(header);
        else if (!standard && header.rfind("Eigen/", 0) != 0)
            out.guests.push_back(header);
    }
    return out;
}

std::string room_of(const std::string& header) {
    return header.substr(0, header.find('/'));
}

// Guests that `file` of `room` sees through the headers of other rooms.
void collect(const std::string& room, const std::string& header, std::set<std::string>& seen,
             std::vector<std::string>& found) {
    if (!seen.insert(header).second) return;
    const Includes includes = includes_of(engine / header);
    if (room_of(header) != room)
        for (const std::string& guest : includes.guests) found.push_back(header + " includes <" + guest + ">");
    for (const std::string& next : includes.own)
        if (fs::exists(engine / next)) collect(room, next, seen, found);
}

}  // namespace

TEST(Includes, NoRoomSeesAPackageThroughAnotherRoomsHeader) {
    for (const fs::path& file : architecture::files_below(engine, {".h", ".cpp", ".inl"})) {
        const std::string name = fs::relative(file, engine).generic_string();
        std::set<std::string> seen;
        std::vector<std::string> found;
        collect(room_of(name), name, seen, found);
        for (const std::string& fault : found) ADD_FAILURE() << name << ": " << fault;
    }
}

TEST(Includes, NoFileOfTheEngineIsAboveFiveHundredLines) {
    for (const fs::path& file : architecture::files_below(engine, {".h", ".cpp", ".inl"}))
        EXPECT_LE(architecture::read_lines(file).size(), 500U) << file;
}

// What a world does is said by its files and by who calls it: a variable of the shell would change it unseen.
TEST(Includes, NoFileOfTheEngineAsksTheEnvironment) {
    static const std::regex pattern(R"(\b(secure_)?getenv\b|\benviron\b)");
    for (const fs::path& file : architecture::files_below(engine, {".h", ".cpp", ".inl"})) {
        int number = 0;
        for (const std::string& line : architecture::read_lines(file)) {
            ++number;
            EXPECT_FALSE(std::regex_search(line, pattern)) << file << ":" << number << ": " << line;
        }
    }
}
