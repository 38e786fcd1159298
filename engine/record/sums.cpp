#include "record/sums.h"

#include <filesystem>
#include <fstream>
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

}  // namespace

void write_sums(const std::string& folder) {
    nlohmann::ordered_json out;
    for (const auto& [name, sum] : sums_now(folder)) out[name] = sum;
    write_whole_file(folder + "/" + file_name, out.dump(2) + "\n");
}

std::vector<std::string> check_sums(const std::string& folder) {
    const std::string path = folder + "/" + file_name;
    std::ifstream in(path);
    if (!in) throw UserError(path + ": cannot be read; a run that was closed has one");
    const auto json = nlohmann::json::parse(in, nullptr, false);
    if (!json.is_object()) throw UserError(path + ": is not a JSON object (edited?)");
    std::map<std::string, std::string> now = sums_now(folder);
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
    return out;
}

}  // namespace cathlab
