#include "record/run_reader.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <string_view>

#include "core/check.h"
#include "core/csv.h"
#include "record/json_lines.h"
#include "record/run_files.h"
#include "scene/toml_document.h"

namespace cathlab {
namespace {

Input parse_input(const nlohmann::json& value, const SourcePlace& where) {
    JsonFields fields(value, where);
    Input input;
    for (const ActionInfo& action : action_table()) {
        double& out = input.*action.value;
        fields.read(std::string(action.name), out);
        if (!(out >= action.minimum && out <= action.maximum))
            throw UserError({where.file, where.line, std::string(action.name)},
                            "found " + std::to_string(out) + ", which no run can have recorded");
    }
    fields.done();
    return input;
}

void read_inputs(RunRecord& run, std::int64_t& end) {
    const std::string path = run.folder + "/inputs.jsonl";
    SourcePlace where{path, 0, ""};
    end = -1;
    for (const std::string& line : read_lines(path, run.manifest.complete)) {
        ++where.line;
        if (end >= 0) throw UserError(where, "a line after the end of the run");
        JsonFields fields(parse_json(line, where), where);
        if (fields.has("end")) {
            fields.read("end", end);
            fields.done();
            continue;
        }
        std::int64_t step = 0;
        fields.read("step", step);
        const Input input = parse_input(fields.member("input"), where);
        fields.done();
        const bool in_order = run.inputs.empty() ? step == 0 : step > run.inputs.back().first;
        if (!in_order) throw UserError(where, "step " + std::to_string(step) + " is out of order");
        run.inputs.emplace_back(step, input);
    }
}

void read_hashes(RunRecord& run) {
    const std::string path = run.folder + "/hashes.csv";
    SourcePlace where{path, 0, ""};
    std::vector<std::string> names;
    for (const std::string& line : read_lines(path, run.manifest.complete)) {
        ++where.line;
        const auto cells = cells_of(line);
        if (where.line == 1) {
            if (cells.size() < 2 || cells[0] != "step" || cells[1] != "whole")
                throw UserError(where, "the header step,whole,... is wanted");
            names.assign(cells.begin(), cells.end());
            continue;
        }
        if (cells.size() != names.size())
            throw UserError(where, "found " + std::to_string(cells.size()) + " cells, " + std::to_string(names.size()) +
                                       " are wanted");
        RecordedHash row;
        const auto steps = parse_number<std::int64_t>(cells[0]);
        if (!steps || *steps < (run.hashes.empty() ? 0 : run.hashes.back().steps + 1))
            throw UserError(where, "found '" + shown(cells[0]) + "'; a step that rises from line to line is wanted");
        row.steps = *steps;
        for (std::size_t i = 1; i < cells.size(); ++i) {
            const auto hash = parse_hash(cells[i]);
            if (!hash) throw UserError(where, "found '" + shown(cells[i]) + "'; sixteen hexadecimal digits are wanted");
            if (i == 1)
                row.hash.whole = *hash;
            else
                row.hash.entities.emplace_back(names[i], *hash);
        }
        run.hashes.push_back(std::move(row));
    }
    if (where.line == 0) throw UserError(where, "is empty");
}

// Of a run that broke off: a row is written after the input that led to it.  Where the inputs end in the middle of a
// line, the system itself went down, and nothing is known of the order in which it wrote.
std::int64_t trace_rows(const std::string& folder) {
    const std::string path = folder + "/trace.csv";
    const std::string inputs = read_text_file(folder + "/inputs.jsonl", most_log_bytes);
    if (!std::filesystem::exists(path) || !inputs.ends_with('\n')) return 0;
    return std::max<std::int64_t>(0, static_cast<std::int64_t>(read_lines(path, false).size()) - 1);
}

}  // namespace

const Input& RunRecord::input_at(std::int64_t step) const {
    CATHLAB_CHECK(!inputs.empty(), "a run that was read has an input for its first step");
    const auto after = std::upper_bound(inputs.begin(), inputs.end(), step,
                                        [](std::int64_t s, const auto& line) { return s < line.first; });
    return std::prev(after)->second;
}

RunRecord read_run(const std::string& folder) {
    const std::string manifest = folder + "/manifest.json";
    if (!std::filesystem::exists(manifest)) throw UserError(folder + ": is no run folder (it has no manifest.json)");
    RunRecord run;
    run.folder = folder;
    run.manifest = parse_manifest(read_text_file(manifest, 1U << 20U), manifest);
    std::int64_t end = -1;
    read_inputs(run, end);
    read_hashes(run);
    const std::int64_t last_input = run.inputs.empty() ? -1 : run.inputs.back().first;
    const std::int64_t last_hash = run.hashes.empty() ? 0 : run.hashes.back().steps;
    if (run.manifest.complete && end != run.manifest.steps)
        throw UserError(folder + "/inputs.jsonl: does not end with the run's " + std::to_string(run.manifest.steps) +
                        " steps (truncated or edited?)");
    run.steps = end >= 0 ? end : std::max({last_input + 1, last_hash, run.manifest.complete ? 0 : trace_rows(folder)});
    if (last_input >= run.steps && run.steps > 0)
        throw UserError(folder + "/inputs.jsonl: has an input for step " + std::to_string(last_input) + " of " +
                        std::to_string(run.steps));
    if (last_hash > run.steps)
        throw UserError(folder + "/hashes.csv: has a hash of step " + std::to_string(last_hash) + " of " +
                        std::to_string(run.steps));
    if (run.steps > 0 && run.inputs.empty()) throw UserError(folder + "/inputs.jsonl: has no input (truncated?)");
    if (run.manifest.complete && last_hash != run.steps)
        throw UserError(folder + "/hashes.csv: does not end with step " + std::to_string(run.steps) +
                        " (truncated or edited?)");
    return run;
}

std::vector<Channels> read_trace(const std::string& folder, bool complete) {
    const std::string path = folder + "/trace.csv";
    SourcePlace where{path, 0, ""};
    const auto channels = channel_table();
    std::vector<Channels> out;
    for (const std::string& line : read_lines(path, complete)) {
        ++where.line;
        const auto cells = cells_of(line);
        if (cells.size() != channels.size() + 1)
            throw UserError(where, "found " + std::to_string(cells.size()) + " columns, " +
                                       std::to_string(channels.size() + 1) + " are wanted");
        if (where.line == 1) {
            for (std::size_t i = 0; i < channels.size(); ++i) {
                const std::string wanted = std::string(channels[i].name) + " [" + std::string(channels[i].unit) + "]";
                if (cells[i + 1] != wanted)
                    throw UserError(where,
                                    "found the column '" + shown(cells[i + 1]) + "', '" + wanted + "' is wanted");
            }
            continue;
        }
        if (parse_number<std::int64_t>(cells[0]) != static_cast<std::int64_t>(out.size()))
            throw UserError(where,
                            "found step '" + shown(cells[0]) + "', " + std::to_string(out.size()) + " is wanted");
        Channels& row = out.emplace_back();
        for (std::size_t i = 0; i < channels.size(); ++i) {
            const auto value = parse_number<double>(cells[i + 1]);
            if (!value)
                throw UserError({path, where.line, std::string(channels[i].name)},
                                "found '" + shown(cells[i + 1]) + "', a number is wanted");
            row.*channels[i].value = *value;
        }
    }
    if (where.line == 0) throw UserError(where, "is empty");
    return out;
}

std::vector<Event> read_events(const std::string& folder, bool complete) {
    const std::string path = folder + "/events.jsonl";
    SourcePlace where{path, 0, ""};
    std::vector<Event> out;
    for (const std::string& line : read_lines(path, complete)) {
        ++where.line;
        JsonFields fields(parse_json(line, where), where);
        Event& event = out.emplace_back();
        fields.read("step", event.step);
        fields.read("time_s", event.time_s);
        fields.read("kind", event.kind);
        fields.read("entity", event.entity);
        fields.read("message", event.message);
        fields.member("value");  // of an event that is not a number it is null, and no picture shows it
        fields.done();
    }
    return out;
}

std::string first_difference(const World::StateHash& recorded, const World::StateHash& now) {
    if (recorded.entities.size() != now.entities.size()) return "the list of entities";
    for (std::size_t i = 0; i < now.entities.size(); ++i) {
        if (recorded.entities[i].first != now.entities[i].first) return "the list of entities";
        if (recorded.entities[i].second != now.entities[i].second) return now.entities[i].first;
    }
    return recorded.whole == now.whole ? "" : "the whole";
}

const ChannelInfo* first_difference(const Channels& recorded, const Channels& now) {
    for (const ChannelInfo& channel : channel_table()) {
        const double a = recorded.*channel.value;
        const double b = now.*channel.value;
        if (std::isnan(a) && std::isnan(b)) continue;  // a table has one NaN only
        if (std::bit_cast<std::uint64_t>(a) != std::bit_cast<std::uint64_t>(b)) return &channel;
    }
    return nullptr;
}

}  // namespace cathlab
