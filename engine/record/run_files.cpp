#include "record/run_files.h"

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>

#include "core/errors.h"
#include "record/manifest.h"
#include "scene/toml_document.h"

namespace cathlab {
namespace fs = std::filesystem;
namespace {

constexpr std::array run_file_names{"manifest.json", "inputs.jsonl", "trace.csv",     "events.jsonl",
                                    "hashes.csv",    "metrics.json", "poster.png",    "fluoro.mp4",
                                    "fluoro.avi",    "labels.json",  "report.html",   "result.json",
                                    "sums.json",     "regions.csv",  "force-map.csv", "poses.bin"};

std::string reason() {
    return std::strerror(errno);
}

void check_earlier_run(const std::string& folder, bool replace) {
    const fs::path manifest = fs::path(folder) / "manifest.json";
    if (!fs::exists(manifest))
        throw UserError(folder + ": the folder is not empty and holds no earlier run; choose another one");
    parse_manifest(read_text_file(manifest.string(), 1U << 20U), manifest.string());
    if (!replace) throw UserError(folder + ": holds an earlier run; choose another folder, or --force to replace it");
}

}  // namespace

void write_whole_file(const std::string& path, const std::string& text) {
    const std::string part = path + ".part";
    std::error_code ignored;
    try {
        LineFile file(part);
        file.add(text.ends_with('\n') ? text.substr(0, text.size() - 1) : text);
        file.close();
        std::error_code error;
        fs::rename(part, path, error);
        if (error) throw UserError(path + ": cannot be written: " + error.message());
    } catch (...) {
        fs::remove(part, ignored);
        throw;
    }
}

void check_run_folder(const std::string& folder, bool replace) {
    std::error_code error;
    if (folder.empty()) throw UserError("the run folder has no name");
    if (fs::exists(folder, error)) {
        if (!fs::is_directory(folder, error)) throw UserError(folder + ": is a file, a folder is wanted");
        const bool empty = fs::is_empty(folder, error);
        if (error) throw UserError(folder + ": the folder cannot be read: " + error.message());
        if (!empty) check_earlier_run(folder, replace);
    }
    fs::path standing = fs::absolute(folder).lexically_normal();
    while (!fs::exists(standing, error) && standing.has_relative_path()) standing = standing.parent_path();
    if (!fs::is_directory(standing, error))
        throw UserError(folder + ": the folder cannot be made: " + standing.string() + " is a file");
    if (::access(standing.c_str(), W_OK | X_OK) != 0)
        throw UserError(folder + ": cannot be written to: " + standing.string() + ": " + reason());
}

void prepare_run_folder(const std::string& folder, bool replace) {
    check_run_folder(folder, replace);
    std::error_code error;
    fs::create_directories(folder, error);
    if (error) throw UserError(folder + ": the folder cannot be made: " + error.message());
    for (const char* name : run_file_names) fs::remove(fs::path(folder) / name, error);
    if (error) throw UserError(folder + ": the earlier run cannot be removed: " + error.message());
}

LineFile::LineFile(const std::string& path) : path_(path), file_(std::fopen(path.c_str(), "wb")) {
    if (!file_) fail();
}

void LineFile::fail() const {
    throw UserError(path_ + ": cannot be written: " + reason());
}

void LineFile::append(const std::string& bytes) {
    if (std::fwrite(bytes.data(), 1, bytes.size(), file_.get()) != bytes.size()) fail();
}

void LineFile::add(const std::string& line) {
    append(line);
    if (std::fputc('\n', file_.get()) == EOF) fail();
}

void LineFile::flush() {
    if (std::fflush(file_.get()) != 0) fail();
}

void LineFile::close() {
    flush();
    // A pipe or /dev/full has nothing to synchronise: EINVAL is no failure of the data.
    if (::fsync(::fileno(file_.get())) != 0 && errno != EINVAL) fail();
    if (std::fclose(file_.release()) != 0) fail();
}

std::vector<std::string> read_lines(const std::string& path, bool complete) {
    const std::string text = read_text_file(path, most_log_bytes);
    std::vector<std::string> lines;
    std::size_t begin = 0;
    while (begin < text.size()) {
        const std::size_t end = text.find('\n', begin);
        if (end == std::string::npos) {
            if (complete) throw UserError({path, static_cast<int>(lines.size() + 1), ""}, "the last line is truncated");
            break;
        }
        lines.push_back(text.substr(begin, end - begin));
        begin = end + 1;
    }
    return lines;
}

}  // namespace cathlab
