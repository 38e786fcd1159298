#include "record/sums.h"

#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>

#include "core/errors.h"
#include "core/hash.h"
#include "record/run_files.h"

namespace cathlab {
namespace fs = std::filesystem;
namespace {

constexpr const char* file_name = "sums.json";

std::map<std::string, std::string> sums_now(const std::string& folder) {
    std::map<std::string, std::string> out;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
        const std::string name = entry.path().filename().string();
        if (entry.is_regular_file() && name != file_name) out[name] = hash_text(hash_file(entry.path().string()));
    }
    return out;
}

std::string list_of(const std::map<std::string, std::string>& sums) {
    nlohmann::ordered_json out;
    for (const auto& [name, sum] : sums) out[name] = sum;
    return out.dump(2) + "\n";
}

}  // namespace

void write_sums(const std::string& folder) {
    write_whole_file(folder + "/" + file_name, list_of(sums_now(folder)));
}

std::vector<std::string> check_sums(const std::string& folder) {
    const std::string path = folder + "/" + file_name;
    std::ifstream in(path, std::ios::binary);
    if (!in) throw UserError(path + ": cannot be read; a run that was closed has one");
    const std::string text{std::istreambuf_iterator<char>(in), {}};
    const auto json = nlohmann::json::parse(text, nullptr, false);
    if (!json.is_object()) throw UserError(path + ": is not a JSON object (edited?)");
    std::map<std::string, std::string> now = sums_now(folder);
    const std::string as_written = list_of(now);
    std::vector<std::string> out;
    const auto tell = [&](const std::string& name, const char* what) {
        out.push_back(folder + "/");
        out.back().append(name).append(what);
    };
    for (const auto& [name, sum] : json.items()) {
        const auto found = now.find(name);
        if (found == now.end())
            tell(name, " is missing");
        else if (!sum.is_string() || sum.get<std::string>() != found->second)
            tell(name, " was changed since the run was closed");
        if (found != now.end()) now.erase(found);
    }
    for (const auto& [name, sum] : now) tell(name, " was added since the run was closed");
    // A blank more or a key that stands twice says the same, and yet somebody wrote it.
    if (out.empty() && text != as_written) tell(file_name, " was changed since the run was closed");
    return out;
}

}  // namespace cathlab
