// Every source that is cited by key stands in docs/references.md, once.
#include <gtest/gtest.h>

#include <regex>
#include <set>

#include "architecture/text.h"

namespace {

namespace fs = std::filesystem;
const fs::path root = CATHLAB_SOURCE_DIR;

std::vector<std::string> listed_keys() {
    static const std::regex pattern(R"(^- \[([^\]]+)\])");
    std::vector<std::string> out;
    std::smatch match;
    for (const std::string& line : architecture::read_lines(root / "docs/references.md"))
        if (std::regex_search(line, match, pattern)) out.push_back(match[1]);
    return out;
}

// The part of a line in which a citation can stand: all of a document, the comment of a source file.
std::string citing_part(const fs::path& file, const std::string& line) {
    if (file.extension() == ".md") return line;
    if (file.extension() == ".toml" && line.find("source") != std::string::npos) return line;
    const auto comment = line.find(file.extension() == ".toml" || file.extension() == ".csv" ? "#" : "//");
    return comment == std::string::npos ? "" : line.substr(comment);
}

}  // namespace

TEST(References, EveryCitedKeyIsListed) {
    const auto keys = listed_keys();
    const std::set<std::string> known(keys.begin(), keys.end());
    // A key is a name and, at its end, a year or a number: [mueller2005], [dicom-ps3.3].  [text](link) is no citation.
    static const std::regex pattern(R"(\[([a-z][a-z0-9.\-]{2,}[0-9][a-z]?)\](?!\())");
    std::vector<fs::path> files = architecture::files_below(root / "docs", {".md"});
    for (const char* folder : {"engine", "app", "assets", "scenes", "shaders"})
        for (const fs::path& file : architecture::files_below(
                 root / folder, {".h", ".cpp", ".inl", ".toml", ".csv", ".glsl", ".frag", ".vert"}))
            files.push_back(file);
    for (const fs::path& file : files) {
        int number = 0;
        for (const std::string& line : architecture::read_lines(file)) {
            ++number;
            const std::string text = citing_part(file, line);
            for (std::sregex_iterator it(text.begin(), text.end(), pattern), end; it != end; ++it)
                EXPECT_TRUE(known.count((*it)[1]))
                    << file.string() << ":" << number << ": [" << (*it)[1] << "] is not in docs/references.md";
        }
    }
}

TEST(References, NoKeyIsListedTwice) {
    std::set<std::string> seen;
    for (const std::string& key : listed_keys()) EXPECT_TRUE(seen.insert(key).second) << key;
    EXPECT_FALSE(seen.empty());
}
