#include "calibrate_output.h"

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "core/csv.h"
#include "core/errors.h"
#include "record/run_files.h"

namespace cathlab {
namespace fs = std::filesystem;
namespace {

// Files of an earlier calibration may be replaced; they say what they are in their first bytes.
constexpr const char* overlay_mark = "# cathlab calibrate ";
constexpr const char* page_mark = "<!-- cathlab calibrate -->\n";
constexpr const char* page_name = "report.html";

void check_place(const std::string& path, const std::string& mark) {
    std::error_code error;
    if (fs::is_directory(path, error)) throw UserError(path + ": is a folder; a file is wanted");
    const fs::path folder = fs::path(path).parent_path();
    if (!folder.empty() && !fs::is_directory(folder, error))
        throw UserError(path + ": there is no folder '" + folder.string() + "'");
    if (!fs::exists(path, error)) return;
    std::ifstream file(path, std::ios::binary);
    std::string begin(mark.size(), '\0');
    file.read(begin.data(), static_cast<std::streamsize>(begin.size()));
    if (!file || begin != mark)
        throw UserError(path + ": is there already and was not written by a calibration; name another file");
}

std::string one_line(std::string text) {
    std::replace_if(
        text.begin(), text.end(), [](char c) { return c >= '\0' && c < ' '; }, ' ');
    return text;
}

}  // namespace

CalibrationOutput::CalibrationOutput(std::string overlay, std::string report)
    : overlay_(std::move(overlay)), report_(std::move(report)) {
    check_place(overlay_, overlay_mark);
    if (report_.empty()) return;
    std::error_code error;
    if (fs::exists(report_, error) && !fs::is_directory(report_, error))
        throw UserError(report_ + ": is a file; a folder is wanted for the report");
    if (fs::is_directory(report_, error)) check_place((fs::path(report_) / page_name).string(), page_mark);
}

void CalibrationOutput::write(const std::string& toml, const std::vector<std::string>& notes, const Page& page) const {
    std::string text = overlay_mark;
    for (const std::string& note : notes) text += (text == overlay_mark ? "" : "# ") + one_line(note) + "\n";
    write_whole_file(overlay_, text + "\n" + toml);
    if (report_.empty()) return;
    std::error_code error;
    fs::create_directories(report_, error);
    if (error) throw UserError(report_ + ": the folder cannot be made: " + error.message());
    write_whole_file((fs::path(report_) / page_name).string(), page_mark + html_page(page));
}

std::string CalibrationOutput::places() const {
    return overlay_ + (report_.empty() ? "" : " and " + (fs::path(report_) / page_name).string());
}

std::string table_text(const PageTable& table) {
    std::vector<std::vector<std::string>> rows{table.header};
    rows.insert(rows.end(), table.rows.begin(), table.rows.end());
    // Columns are counted in letters, and of a letter of several bytes only the first counts.
    const auto letters = [](const std::string& s) {
        return static_cast<std::size_t>(
            std::count_if(s.begin(), s.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; }));
    };
    std::vector<std::size_t> width(table.header.size(), 0);
    for (const auto& row : rows)
        for (std::size_t k = 0; k < row.size() && k < width.size(); ++k) width[k] = std::max(width[k], letters(row[k]));
    std::string out = table.caption + "\n";
    for (const auto& row : rows) {
        std::string line;
        for (std::size_t k = 0; k < row.size() && k < width.size(); ++k) {
            const std::string room(width[k] - letters(row[k]) + 2, ' ');
            line += k == 0 ? "  " + row[k] + room : room + row[k];
        }
        line.erase(line.find_last_not_of(' ') + 1);
        out += line + "\n";
    }
    return out;
}

std::pair<double, double> parse_range(const std::string& option, const std::string& text) {
    const auto colon = text.find(':');
    const bool two = colon != std::string::npos;
    const auto low = finite_number(std::string_view(text).substr(0, colon));
    const auto high = two ? finite_number(std::string_view(text).substr(colon + 1)) : std::nullopt;
    if (!low || !high) throw UserError(option + " '" + text + "': two numbers LOW:HIGH are wanted", true);
    if (*low >= *high) throw UserError(option + " '" + text + "': the range is turned round or empty", true);
    return {*low, *high};
}

FreeRange parse_free(const std::string& text) {
    const auto equals = text.find('=');
    if (equals == std::string::npos || equals == 0)
        throw UserError("--free '" + text + "': PATH=LOW:HIGH is wanted, as wall.cluster_stiffness=0.4:0.9", true);
    const auto [low, high] = parse_range("--free", text.substr(equals + 1));
    return {text.substr(0, equals), low, high};
}

}  // namespace cathlab
