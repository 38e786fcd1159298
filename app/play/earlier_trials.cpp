#include "play/earlier_trials.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

namespace cathlab::play {
namespace fs = std::filesystem;
namespace {

constexpr std::size_t most_shown = 8;

}  // namespace

std::vector<ResultView::Earlier> earlier_trials(const std::string& folder, const std::string& task,
                                                const std::string& except) {
    std::vector<ResultView::Earlier> out;
    std::error_code error;
    for (const auto& entry : fs::directory_iterator(folder, error)) {
        if (entry.path() == fs::path(except)) continue;
        std::ifstream in(entry.path() / "result.json");
        if (!in) continue;
        const auto json = nlohmann::json::parse(in, nullptr, false);
        if (!json.is_object() || json.value("task", "") != task) continue;
        const auto number = [&](const char* key) {
            const auto it = json.find(key);
            return it != json.end() && it->is_number() ? it->get<double>() : 0.0;
        };
        out.push_back({entry.path().filename().string(), number("score"), number("play_time_s"),
                       number("force_bar_max"), number("fluoroscopy_time_s"), json.value("difficulty", "")});
    }
    // Folders begin with the date.
    std::sort(out.begin(), out.end(), [](const auto& a, const auto& b) { return a.name > b.name; });
    if (out.size() > most_shown) out.resize(most_shown);
    return out;
}

}  // namespace cathlab::play
