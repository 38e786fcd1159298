#include "context.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <filesystem>
#include <string_view>
#include <vector>

#include "core/errors.h"

namespace cathlab {
namespace fs = std::filesystem;
namespace {

// A signal handler may touch nothing else.  The program has one main loop, so one flag.
volatile std::sig_atomic_t stop_flag = 0;

extern "C" void on_stop_signal(int signal) {
    stop_flag = 1;
    std::signal(signal, SIG_DFL);  // whoever asks twice does not want to wait
}

std::string environment(const char* name) {
    const char* value = std::getenv(name);
    return value == nullptr ? "" : value;
}

}  // namespace

std::string find_data_root() {
    std::error_code error;
    if (std::string named = environment("CATHLAB_DATA_DIR"); !named.empty()) {
        if (fs::is_directory(fs::path(named) / "assets", error)) return named;
        throw UserError("CATHLAB_DATA_DIR is '" + named + "', which holds no folder assets", true);
    }
    std::vector<fs::path> tried{CATHLAB_SOURCE_DIR};
    const fs::path beside = fs::read_symlink("/proc/self/exe", error).parent_path();
    if (!error) {
        tried.push_back(beside.parent_path() / "share" / "cathlab");
        tried.push_back(beside);
    }
    std::vector<std::string> names;
    for (const fs::path& path : tried) {
        if (fs::is_directory(path / "assets", error)) return path.string();
        names.push_back(path.string());
    }
    throw UserError("the program's data (a folder with assets) are in none of " + comma_list(names) +
                    "; name their folder in CATHLAB_DATA_DIR");
}

std::string find_cache_folder() {
    if (std::string named = environment("CATHLAB_CACHE_DIR"); !named.empty()) return named;
    if (const std::string cache = environment("XDG_CACHE_HOME"); !cache.empty()) return cache + "/cathlab";
    if (const std::string home = environment("HOME"); !home.empty()) return home + "/.cache/cathlab";
    return "";
}

std::string path_for_manifest(const std::string& path, const std::string& data_root) {
    std::error_code error;
    const fs::path full = fs::weakly_canonical(path, error);
    if (error) return path;
    const fs::path inside = full.lexically_relative(fs::weakly_canonical(data_root, error));
    if (error || inside.empty() || *inside.begin() == "..") return full.string();
    return inside.string();
}

std::string shell_command(int argc, const char* const* argv) {
    constexpr std::string_view plain_marks = "_-+=:,./@%";
    const auto plain = [&](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
               plain_marks.find(c) != std::string_view::npos;
    };
    std::string out;
    for (int i = 0; i < argc; ++i) {
        const std::string word = i == 0 ? fs::path(argv[0]).filename().string() : argv[i];
        if (i > 0) out += ' ';
        if (!word.empty() && std::all_of(word.begin(), word.end(), plain)) {
            out += word;
            continue;
        }
        out += '\'';
        for (const char c : word) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
        out += '\'';
    }
    return out;
}

void catch_stop_signals() {
    std::signal(SIGINT, on_stop_signal);
    std::signal(SIGTERM, on_stop_signal);
}

bool stop_wanted() {
    return stop_flag != 0;
}

}  // namespace cathlab
