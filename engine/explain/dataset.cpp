#include "explain/dataset.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "core/errors.h"
#include "explain/data_csv.h"
#include "explain/dataset_kinds.h"
#include "scene/toml_document.h"

namespace cathlab {
namespace {

namespace fs = std::filesystem;

const TomlNode& member(const TomlNode& table, const std::string& key, TomlKind kind, const char* wanted) {
    const TomlNode* node = table.find(key);
    if (node == nullptr) throw UserError(table.place(key), std::string("is missing; ") + wanted + " is wanted");
    const bool whole_for_number = kind == TomlKind::number && node->kind == TomlKind::integer;
    if (node->kind != kind && !whole_for_number)
        throw UserError(node->place(key), "found " + node->describe() + "; " + wanted + " is wanted");
    return *node;
}

double number(const TomlNode& node, const std::string& key) {
    const bool fine = (node.kind == TomlKind::number || node.kind == TomlKind::integer) && std::isfinite(node.number);
    if (!fine) throw UserError(node.place(key), "found " + node.describe() + "; a finite number is wanted");
    return node.number;
}

void refuse_unknown(const TomlNode& table, const std::vector<std::string>& known) {
    for (const auto& [key, node] : table.members)
        if (std::find(known.begin(), known.end(), key) == known.end())
            throw UserError(node.place(key), "no such key" + did_you_mean(key, known) + " Known: " + comma_list(known));
}

HeartMotionSetup heart_setup(const TomlNode& setup) {
    refuse_unknown(setup, {"beat_times_s", "axis"});
    HeartMotionSetup out;
    const char* wanted = "a list of beat times for each run";
    for (const TomlNode& run : member(setup, "beat_times_s", TomlKind::array, wanted).items) {
        if (run.kind != TomlKind::array) throw UserError(run.place("beat_times_s"), std::string(wanted) + " is wanted");
        auto& beats = out.beat_times_s.emplace_back();
        for (const TomlNode& beat : run.items) {
            beats.push_back(number(beat, "beat_times_s"));
            if (beats.size() > 1 && beats.back() <= beats[beats.size() - 2])
                throw UserError(beat.place("beat_times_s"), "beats must rise in time");
        }
    }
    if (const TomlNode* axis = setup.find("axis")) {
        if (axis->kind != TomlKind::array || axis->items.size() != 3)
            throw UserError(axis->place("axis"), "found " + axis->describe() + "; three numbers are wanted");
        Vec3 v;
        for (int k = 0; k < 3; ++k) v[k] = number(axis->items[static_cast<std::size_t>(k)], "axis");
        const double length = std::sqrt(v.squaredNorm());
        if (length <= 0.0) throw UserError(axis->place("axis"), "an axis of length 0 has no direction");
        out.axis = v / length;
    }
    return out;
}

WallTensionSetup wall_setup(const TomlNode& setup) {
    refuse_unknown(setup, {"specimen", "thickness_mm", "mode"});
    WallTensionSetup out;
    if (setup.find("specimen") != nullptr) out.specimen = member(setup, "specimen", TomlKind::text, "a text").text;
    if (setup.find("mode") != nullptr) out.mode = member(setup, "mode", TomlKind::text, "a text").text;
    const TomlNode& thickness = member(setup, "thickness_mm", TomlKind::number, "a number above 0, mm");
    out.thickness_mm = number(thickness, "thickness_mm");
    if (out.thickness_mm <= 0.0)
        throw UserError(thickness.place("thickness_mm"), "found " + thickness.describe() + "; above 0 is wanted");
    return out;
}

void read_description(const fs::path& file, Dataset& out) {
    const TomlNode toml = load_toml(file.string());
    refuse_unknown(toml, {"format", "kind", "title", "source", "license", "declared_effects", "sensor_noise", "setup"});
    const TomlNode& format = member(toml, "format", TomlKind::integer, "1");
    if (format.integer != 1) throw UserError(format.place("format"), "found " + format.describe() + "; 1 is wanted");
    const TomlNode& kind = member(toml, "kind", TomlKind::text, "a text");
    out.kind = kind.text;
    const auto& kinds = dataset_kinds();
    if (std::find(kinds.begin(), kinds.end(), out.kind) == kinds.end())
        throw UserError(kind.place("kind"), "found " + kind.describe() + "; one of " + comma_list(kinds) +
                                                " is wanted" + did_you_mean(out.kind, kinds));
    out.title = member(toml, "title", TomlKind::text, "a text").text;
    out.source = member(toml, "source", TomlKind::text, "a text").text;
    out.license = member(toml, "license", TomlKind::text, "a text").text;
    for (const TomlNode& effect : member(toml, "declared_effects", TomlKind::array, "a list of names").items) {
        if (effect.kind != TomlKind::text)
            throw UserError(effect.place("declared_effects"), "found " + effect.describe() + "; a name is wanted");
        out.declared_effects.push_back(effect.text);
    }
    const TomlNode& noise = member(toml, "sensor_noise", TomlKind::number, "a number, 0 or more");
    out.sensor_noise = number(noise, "sensor_noise");
    if (out.sensor_noise < 0.0)
        throw UserError(noise.place("sensor_noise"), "found " + noise.describe() + "; 0 or more is wanted");
    const TomlNode& setup = member(toml, "setup", TomlKind::table, "a section [setup]");
    if (out.kind == "heart-motion") out.heart = heart_setup(setup);
    if (out.kind == "wall-tension") out.wall = wall_setup(setup);
}

}  // namespace

std::vector<const DataColumn*> Dataset::of_role(ColumnRole role) const {
    std::vector<const DataColumn*> out;
    for (const DataColumn& column : columns)
        if (column.role == role) out.push_back(&column);
    return out;
}

const DataColumn* Dataset::find(const std::string& quantity) const {
    for (const DataColumn& column : columns)
        if (column.quantity == quantity) return &column;
    return nullptr;
}

Dataset read_dataset(const std::string& folder) {
    Dataset out;
    out.folder = folder;
    const fs::path path(folder);
    if (!fs::is_directory(path))
        throw UserError(folder + ": is no folder; a data set is one with dataset.toml and data.csv");
    read_description(path / "dataset.toml", out);
    read_data_csv((path / "data.csv").string(), out);
    if (!out.heart.beat_times_s.empty() && out.heart.beat_times_s.size() != out.run_names.size())
        throw UserError({(path / "dataset.toml").string(), 0, "setup.beat_times_s"},
                        "found " + std::to_string(out.heart.beat_times_s.size()) + " lists for " +
                            std::to_string(out.run_names.size()) + " runs in data.csv");
    return out;
}

}  // namespace cathlab
