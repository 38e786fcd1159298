#include "record/run_writer.h"

#include <array>
#include <charconv>
#include <cmath>

#include "core/check.h"
#include "record/json_lines.h"

namespace cathlab {
namespace {

constexpr std::int64_t flush_interval =
    25;  // steps: half a second of a run at the usual step is the most a crash may take

bool same(const Input& a, const Input& b) {
    for (const ActionInfo& action : action_table())
        if (a.*action.value != b.*action.value) return false;
    return true;
}

std::string dump(const nlohmann::ordered_json& line) {
    return line.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

}  // namespace

std::string exact_number(double value) {
    std::array<char, 64> buffer{};
    const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value).ptr;
    return {buffer.data(), end};
}

std::string event_line(const Event& event) {
    return dump({{"step", event.step},
                 {"time_s", event.time_s},
                 {"kind", event.kind},
                 {"entity", event.entity},
                 {"message", event.message},
                 {"value", event.value}});
}

RunWriter::RunWriter(const std::string& folder, RunManifest manifest, const std::vector<std::string>& entities)
    : folder_(folder),
      manifest_(std::move(manifest)),
      inputs_(folder + "/inputs.jsonl"),
      trace_(folder + "/trace.csv"),
      events_(folder + "/events.jsonl"),
      hashes_(folder + "/hashes.csv") {
    manifest_.complete = false;
    manifest_.steps = 0;
    file("manifest.json", manifest_json(manifest_));
    std::string header = "step";
    for (const ChannelInfo& channel : channel_table())
        header += "," + std::string(channel.name) + " [" + std::string(channel.unit) + "]";
    trace_.add(header);
    header = "step,whole";
    for (const std::string& name : entities) {
        CATHLAB_CHECK(name.find_first_of(",\n\"") == std::string::npos, "an entity's name must fit into a table");
        header += "," + name;
    }
    hashes_.add(header);
}

void RunWriter::input(std::int64_t step, const Input& wanted) {
    const Input input = in_range(wanted);
    if (last_input_ && same(*last_input_, input)) return;
    last_input_ = input;
    nlohmann::ordered_json values;
    for (const ActionInfo& action : action_table()) values[std::string(action.name)] = input.*action.value;
    inputs_.add(dump({{"step", step}, {"input", std::move(values)}}));
    inputs_.flush();  // no row of the trace may reach the disk before the input that made it
}

void RunWriter::step(std::int64_t step, const Channels& channels, const std::vector<Event>& events) {
    std::string row = std::to_string(step);
    for (const ChannelInfo& channel : channel_table()) row += "," + exact_number(channels.*channel.value);
    trace_.add(row);
    for (const Event& event : events) events_.add(event_line(event));
    if (flushes(step)) flush();
}

bool RunWriter::flushes(std::int64_t step) {
    return (step + 1) % flush_interval == 0;
}

void RunWriter::flush() {
    inputs_.flush();
    trace_.flush();
    events_.flush();
    hashes_.flush();
}

void RunWriter::hash(std::int64_t steps, const World::StateHash& hash) {
    std::string row = std::to_string(steps) + "," + hash_text(hash.whole);
    for (const auto& [name, value] : hash.entities) row += "," + hash_text(value);
    hashes_.add(row);
}

void RunWriter::file(const std::string& name, const std::string& text) const {
    write_whole_file(folder_ + "/" + name, text);
}

void RunWriter::finish(std::int64_t steps, bool complete, double wall_time_s, const std::string& video) {
    inputs_.add(dump({{"end", steps}}));
    inputs_.close();
    trace_.close();
    events_.close();
    hashes_.close();
    manifest_.steps = steps;
    manifest_.complete = complete;
    manifest_.wall_time_s = wall_time_s;
    manifest_.video = video;
    file("manifest.json", manifest_json(manifest_));
}

}  // namespace cathlab
