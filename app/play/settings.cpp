#include "play/settings.h"

#include <array>
#include <charconv>
#include <cstdlib>
#include <filesystem>

#include "core/errors.h"
#include "record/run_files.h"

namespace cathlab::play {
namespace fs = std::filesystem;
namespace {

Table<InputSettings> input_table() {
    const auto stick =
        Table<StickShape>("how a stick's place becomes a speed")
            .number("dead_zone", &StickShape::dead_zone, "1", {0, 0.9}, "radius in which it is at rest")
            .number("outer_zone", &StickShape::outer_zone, "1", {0, 0.5}, "at the rim, full already")
            .number("curve", &StickShape::curve, "1", {1, 4}, "1 = straight; more = finer in the middle");
    return Table<InputSettings>("hands")
        .include(&InputSettings::stick, stick)
        .number("advance_mm_s", &InputSettings::advance_mm_s, "mm/s", {1, 100}, "fastest push and pull")
        .number("rotate_deg_s", &InputSettings::rotate_deg_s, "deg/s", {5, 360}, "fastest turn of a device")
        .number("bend_deg_s", &InputSettings::bend_deg_s, "deg/s", {1, 180}, "fastest bend")
        .number("direction_deg_s", &InputSettings::direction_deg_s, "deg/s", {5, 360}, "fastest turn of a bend")
        .number("c_arm_deg_s", &InputSettings::c_arm_deg_s, "deg/s", {1, 25}, "fastest C-arm")
        .number("table_mm_s", &InputSettings::table_mm_s, "mm/s", {5, 150}, "fastest table")
        .number("contrast_ml_s", &InputSettings::contrast_ml_s, "mL/s", {0.5, 30}, "flow of contrast medium")
        .number("precision", &InputSettings::precision, "1", {0.05, 1}, "share of the speed while 'slowly' is held")
        .number("jog_mm", &InputSettings::jog_mm, "mm", {0.1, 10}, "length of a step in step mode")
        .boolean("left_handed", &InputSettings::left_handed, "sticks, triggers and shoulder buttons change sides")
        .boolean("toggle_pedals", &InputSettings::toggle_pedals, "pedals stay down until they are pressed again")
        .number("rumble", &InputSettings::rumble, "1", {0, 1}, "strength of the pad's trembling; 0 = off");
}

Table<Settings> make_table() {
    const auto view =
        Table<ViewSettings>("what is shown")
            .number("hud_scale", &ViewSettings::hud_scale, "1", {0.75, 2.5}, "size of all text and bars")
            .integer("largest_picture", &ViewSettings::largest_picture, "px", {128, 2048},
                     "side of the fluoroscopy that is computed; a larger window stretches it")
            .choice("palette", &ViewSettings::palette, {"colour-blind", "high-contrast"}, "colours of the force bar")
            .boolean("fullscreen", &ViewSettings::fullscreen, "the whole screen");
    const auto sound = Table<SoundSettings>("tones")
                           .boolean("enabled", &SoundSettings::enabled, "X-ray tone and alarm")
                           .number("volume", &SoundSettings::volume, "1", {0, 1}, "loudness")
                           .boolean("force_tone", &SoundSettings::force_tone, "a tone that rises with the force");
    const auto run = Table<RunSettings>("recording")
                         .boolean("record", &RunSettings::record, "every session is kept as a run folder")
                         .text("folder", &RunSettings::folder, "where; empty = the user's data folder")
                         .text("participant", &RunSettings::participant, "pseudonym, for studies")
                         .integer("threads", &RunSettings::threads, "1", {1, 64}, "threads of the simulation");
    return Table<Settings>("settings of the trainer")
        .table("input", &Settings::input, input_table())
        .table("view", &Settings::view, view)
        .table("sound", &Settings::sound, sound)
        .table("run", &Settings::run, run)
        .table("bindings", &Settings::bindings, bindings_table());
}

std::string below(const char* variable, const char* beside_home) {
    if (const char* named = std::getenv(variable); named != nullptr && *named != '\0')
        return std::string(named) + "/cathlab";
    if (const char* home = std::getenv("HOME"); home != nullptr && *home != '\0')
        return std::string(home) + beside_home + "/cathlab";
    return "";
}

std::string number_text(double value) {
    std::array<char, 64> buffer{};
    const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value).ptr;
    std::string text(buffer.data(), end);
    return text.find_first_of(".en") == std::string::npos ? text + ".0" : text;
}

std::string quoted(const std::string& text) {
    std::string out = "\"";
    for (const char c : text) {
        if (c == '"' || c == '\\') out += '\\';
        if (static_cast<unsigned char>(c) >= 0x20) out += c;
    }
    return out + "\"";
}

std::string value_text(const FieldValue& value) {
    if (const auto* number = std::get_if<double>(&value)) return number_text(*number);
    if (const auto* integer = std::get_if<std::int64_t>(&value)) return std::to_string(*integer);
    if (const auto* boolean = std::get_if<bool>(&value)) return *boolean ? "true" : "false";
    if (const auto* text = std::get_if<std::string>(&value)) return quoted(*text);
    std::string out = "[";
    if (const auto* texts = std::get_if<std::vector<std::string>>(&value))
        for (const std::string& text : *texts) out += (out.size() > 1 ? ", " : "") + quoted(text);
    return out + "]";
}

}  // namespace

const Table<Settings>& settings_table() {
    static const Table<Settings> table = make_table();
    return table;
}

std::string settings_path() {
    const std::string folder = below("XDG_CONFIG_HOME", "/.config");
    return folder.empty() ? "" : folder + "/play.toml";
}

std::string data_home() {
    return below("XDG_DATA_HOME", "/.local/share");
}

Settings read_settings(const std::string& path) {
    return read_table(load_toml(path), settings_table());
}

Settings read_or_default(const std::string& path) {
    std::error_code error;
    return path.empty() || !fs::exists(path, error) ? Settings{} : read_settings(path);
}

LoadedSettings load_settings(const std::string& path) {
    LoadedSettings out;
    std::error_code error;
    if (path.empty() || !fs::exists(path, error)) return out;
    try {
        out.settings = read_settings(path);
    } catch (const UserError& fault) {
        fs::rename(path, path + ".broken", error);
        out.message = std::string("settings: ") + fault.what() + "; the defaults are used" +
                      (error ? "" : ", and the file is kept as " + path + ".broken");
    }
    return out;
}

std::string settings_toml(const Settings& settings) {
    std::string out = "# Settings of the trainer (cathlab play).  What is missing has its default.\n";
    Settings copy = settings;
    for (const FieldSpec& section : settings_table().spec().fields) {
        out += "\n[" + section.key + "]\n";
        const void* object = section.open(&copy);
        for (const FieldSpec& field : section.sub->fields) {
            const std::string unit = field.unit.empty() || field.unit == "1" ? "" : field.unit + ": ";
            out += field.key + " = " + value_text(field.load(object)) + "  # " + unit + field.doc + "\n";
        }
    }
    return out;
}

void save_settings(const Settings& settings, const std::string& path) {
    if (path.empty()) throw UserError("settings cannot be kept: neither XDG_CONFIG_HOME nor HOME is set");
    std::error_code error;
    fs::create_directories(fs::path(path).parent_path(), error);
    if (error) throw UserError("cannot make the folder of '" + path + "': " + error.message());
    write_whole_file(path, settings_toml(settings));
}

}  // namespace cathlab::play
