#include "explain/dataset.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <numeric>

#include "core/errors.h"
#include "explain/data_csv.h"
#include "explain/dataset_kinds.h"
#include "explain/description.h"

namespace cathlab {
namespace {

namespace fs = std::filesystem;

HeartMotionSetup heart_setup(const TomlNode& setup) {
    refuse_unknown(setup, {"beat_times_s", "axis"});
    HeartMotionSetup out;
    const char* wanted = "a list of beat times for each run";
    for (const TomlNode& run : described(setup, "beat_times_s", TomlKind::array, wanted).items) {
        if (run.kind != TomlKind::array) throw UserError(run.place("beat_times_s"), std::string(wanted) + " is wanted");
        auto& beats = out.beat_times_s.emplace_back();
        for (const TomlNode& beat : run.items) {
            beats.push_back(described_number(beat, "beat_times_s"));
            if (beats.size() > 1 && beats.back() <= beats[beats.size() - 2])
                throw UserError(beat.place("beat_times_s"), "beats must rise in time");
        }
    }
    if (const TomlNode* axis = setup.find("axis")) out.axis = described_direction(*axis, "axis");
    return out;
}

WallTensionSetup wall_setup(const TomlNode& setup) {
    refuse_unknown(setup, {"specimen", "thickness_mm", "mode"});
    WallTensionSetup out;
    if (setup.find("specimen") != nullptr) out.specimen = described(setup, "specimen", TomlKind::text, "a text").text;
    if (setup.find("mode") != nullptr) out.mode = described(setup, "mode", TomlKind::text, "a text").text;
    out.thickness_mm = described_above_zero(setup, "thickness_mm");
    return out;
}

/// The columns that the setup names as tendons become inputs.
void find_tendons(const std::string& file, Dataset& out) {
    for (TendonSegmentSetup& segment : out.tendons.segments)
        for (const std::string& name : segment.tendons) {
            const auto it = std::find_if(out.columns.begin(), out.columns.end(),
                                         [&](const DataColumn& column) { return column.name == name; });
            if (it == out.columns.end()) {
                std::vector<std::string> names;
                for (const DataColumn& column : out.columns) names.push_back(column.name);
                throw UserError({file, 0, "setup.segment '" + segment.name + "'"},
                                "data.csv has no column '" + name + "'" + did_you_mean(name, names));
            }
            if (it->unit != "mm")
                throw UserError({file, 0, "setup.segment '" + segment.name + "'"},
                                "the column '" + name + "' is no length; one in _mm or _m is wanted");
            if (it->role == ColumnRole::measured)
                throw UserError({file, 0, "setup.segment '" + segment.name + "'"},
                                "the column '" + name + "' is measured and cannot be a tendon");
            it->role = ColumnRole::input;
            segment.columns.push_back(static_cast<std::size_t>(it - out.columns.begin()));
        }
}

/// Rows of one run one after another, in the order in which the runs appear.
void join_runs(Dataset& out) {
    if (std::is_sorted(out.run.begin(), out.run.end())) return;
    std::vector<std::size_t> order(out.rows());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return out.run[a] < out.run[b]; });
    const auto arrange = [&](auto& values) {
        auto old = values;
        for (std::size_t i = 0; i < order.size(); ++i) values[i] = old[order[i]];
    };
    arrange(out.run);
    arrange(out.time_s);
    if (!out.held_out.empty()) arrange(out.held_out);
    for (DataColumn& column : out.columns) arrange(column.values);
    for (LabelColumn& label : out.labels) arrange(label.values);
}

/// What was done is needed at every row, since devices remember: an input that is missing stays as it was last (at the
/// beginning as it is first), and what was measured at such a row counts as missing.  Throws UserError where a run has
/// no value of an input at all.
void hold_inputs(const std::string& file, Dataset& out) {
    std::vector<std::uint8_t> unknown(out.rows(), 0);
    for (DataColumn& column : out.columns) {
        if (column.role != ColumnRole::input) continue;
        for (std::size_t begin = 0, end = 0; begin < out.rows(); begin = end) {
            while (end < out.rows() && out.run[end] == out.run[begin]) ++end;
            const auto first = column.values.begin() + static_cast<std::ptrdiff_t>(begin);
            const auto last = column.values.begin() + static_cast<std::ptrdiff_t>(end);
            const auto known = std::find_if(first, last, [](double v) { return !std::isnan(v); });
            if (known == last)
                throw UserError({file, 0, "column " + column.name},
                                "has no value in run " + out.run_names[static_cast<std::size_t>(out.run[begin])]);
            double held = *known;
            for (std::size_t i = begin; i < end; ++i) {
                if (std::isnan(column.values[i])) {
                    unknown[i] = 1;
                    column.values[i] = held;
                }
                held = column.values[i];
            }
        }
    }
    for (DataColumn& column : out.columns)
        for (std::size_t i = 0; i < out.rows(); ++i)
            if (column.role == ColumnRole::measured && unknown[i] != 0)
                column.values[i] = std::numeric_limits<double>::quiet_NaN();
}

void read_description(const fs::path& file, Dataset& out) {
    const TomlNode toml = load_toml(file.string());
    refuse_unknown(toml, {"format", "kind", "title", "source", "license", "declared_effects", "sensor_noise", "setup"});
    const TomlNode& format = described(toml, "format", TomlKind::integer, "1");
    if (format.integer != 1) throw UserError(format.place("format"), "found " + format.describe() + "; 1 is wanted");
    const TomlNode& kind = described(toml, "kind", TomlKind::text, "a text");
    out.kind = kind.text;
    const auto& kinds = dataset_kinds();
    if (std::find(kinds.begin(), kinds.end(), out.kind) == kinds.end())
        throw UserError(kind.place("kind"), "found " + kind.describe() + "; one of " + comma_list(kinds) +
                                                " is wanted" + did_you_mean(out.kind, kinds));
    out.title = described(toml, "title", TomlKind::text, "a text").text;
    out.source = described(toml, "source", TomlKind::text, "a text").text;
    out.license = described(toml, "license", TomlKind::text, "a text").text;
    for (const TomlNode& effect : described(toml, "declared_effects", TomlKind::array, "a list of names").items) {
        if (effect.kind != TomlKind::text)
            throw UserError(effect.place("declared_effects"), "found " + effect.describe() + "; a name is wanted");
        out.declared_effects.push_back(effect.text);
    }
    const TomlNode& noise = described(toml, "sensor_noise", TomlKind::number, "a number, 0 or more");
    out.sensor_noise = described_number(noise, "sensor_noise");
    if (out.sensor_noise < 0.0)
        throw UserError(noise.place("sensor_noise"), "found " + noise.describe() + "; 0 or more is wanted");
    const TomlNode& setup = described(toml, "setup", TomlKind::table, "a section [setup]");
    if (out.kind == "catheter-tip") out.catheter = catheter_setup(setup);
    if (out.kind == "tendon-tip") out.tendons = tendon_setup(setup);
    if (out.kind == "heart-motion") out.heart = heart_setup(setup);
    if (out.kind == "wall-tension") out.wall = wall_setup(setup);
    if (out.kind == "wall-contact") out.contact = contact_setup(setup, file.parent_path().string());
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
    if (out.kind == "tendon-tip") find_tendons((path / "dataset.toml").string(), out);
    join_runs(out);
    if (out.kind == "catheter-tip" || out.kind == "tendon-tip") hold_inputs((path / "data.csv").string(), out);
    if (!out.heart.beat_times_s.empty() && out.heart.beat_times_s.size() != out.run_names.size())
        throw UserError({(path / "dataset.toml").string(), 0, "setup.beat_times_s"},
                        "found " + std::to_string(out.heart.beat_times_s.size()) + " lists for " +
                            std::to_string(out.run_names.size()) + " runs in data.csv");
    if (out.kind == "wall-contact" && out.contact.sensor_rest_mm.size() != out.run_names.size())
        throw UserError({(path / "dataset.toml").string(), 0, "setup.sensor_rest_mm"},
                        "found " + std::to_string(out.contact.sensor_rest_mm.size()) + " places for " +
                            std::to_string(out.run_names.size()) + " runs in data.csv");
    return out;
}

}  // namespace cathlab
