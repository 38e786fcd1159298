#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "core/errors.h"
#include "core/hash.h"
#include "record/manifest.h"
#include "study/run_index.h"

namespace cathlab {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

std::string read_text(const fs::path& file) {
    std::ifstream in(file);
    if (!in) throw UserError(file.string() + ": cannot be read");
    return {std::istreambuf_iterator<char>(in), {}};
}

Json read_json(const fs::path& file) {
    Json out = Json::parse(read_text(file), nullptr, false);
    if (out.is_discarded() || !out.is_object()) throw UserError(file.string() + ": is not a JSON object");
    return out;
}

template <class T>
T value_or(const Json& json, const fs::path& file, const char* key, T fallback) {
    const auto it = json.find(key);
    if (it == json.end() || it->is_null()) return fallback;
    try {
        return it->get<T>();
    } catch (const Json::exception&) {
        throw UserError({file.string(), 0, key}, "has the wrong type: " + it->dump());
    }
}

}  // namespace

void check_pseudonym(const std::string& text) {
    constexpr std::size_t longest = 32;
    const bool plain =
        text.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-") == std::string::npos;
    if (text.empty() || text.size() > longest || !plain)
        throw UserError("'" + text +
                        "' is no pseudonym: use letters, digits, '-' and '_', at most 32, for instance P07");
}

RunEntry read_run_folder(const std::string& root, const std::string& folder) {
    const fs::path path = fs::path(root) / folder;
    const fs::path manifest_file = path / "manifest.json";
    const RunManifest manifest = parse_manifest(read_text(manifest_file), manifest_file.string());
    RunEntry entry;
    entry.folder = fs::path(folder).lexically_normal().generic_string();
    entry.scene = manifest.scene;
    entry.scene_hash = hash_text(manifest.scene_hash);
    entry.version = manifest.version;
    entry.complete = manifest.complete;
    const fs::path trial_file = path / "trial.json";
    if (fs::exists(trial_file)) {
        const Json trial = read_json(trial_file);
        entry.participant = value_or<std::string>(trial, trial_file, "participant", "");
        entry.group = value_or<std::string>(trial, trial_file, "group", "");
        entry.task = value_or<std::string>(trial, trial_file, "task", "");
        entry.trial = value_or(trial, trial_file, "trial", 0);
        if (!entry.participant.empty()) check_pseudonym(entry.participant);
    }
    const fs::path metrics_file = path / "metrics.json";
    if (!fs::exists(metrics_file)) {
        if (entry.complete) throw UserError(metrics_file.string() + ": is missing");
        return entry;
    }
    const Json metrics = read_json(metrics_file);
    for (const auto& [name, value] : metrics.items())
        if (value.is_number()) entry.metrics[name] = value.get<double>();
    const fs::path result_file = path / "result.json";
    if (!fs::exists(result_file)) return entry;
    const Json result = read_json(result_file);
    if (const auto it = result.find("reached"); it != result.end() && it->is_boolean())
        entry.metrics["goal_reached"] = it->get<bool>() ? 1.0 : 0.0;
    if (const auto it = result.find("score"); it != result.end() && it->is_number())
        entry.metrics["score"] = it->get<double>();
    if (const auto aids = result.find("aids"); aids != result.end() && aids->is_object())
        for (const auto& [name, value] : aids->items())
            if (value.is_number()) entry.metrics[name] = value.get<double>();
    return entry;
}

}  // namespace cathlab
