#include "play/setup.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>

#include "core/errors.h"
#include "effects/effect.h"
#include "scene/load_scene.h"
#include "scene/toml_document.h"

namespace cathlab::play {
namespace {

constexpr double start_beyond_sheath_mm = 60.0, catheter_beyond_sheath_mm = 5.0;

std::string device_kind(const std::string& path) {
    const TomlNode file = load_toml(path);
    const TomlNode* kind = file.find("kind");
    return kind != nullptr ? kind->text : "";
}

std::string device_name(const SceneDevice& device) {
    return device.enabled ? std::filesystem::path(device.device).stem().string() : "";
}

std::string number(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.6g", value);
    return std::string(text).find_first_of(".e") == std::string::npos ? std::string(text) + ".0" : text;
}

bool switched_on(const SceneSpec& scene, const std::string& effect) {
    return std::any_of(scene.effects.begin(), scene.effects.end(),
                       [&](const SceneEffect& e) { return e.enabled && e.info->name == effect; });
}

std::string device_toml(const char* section, const std::string& name, const std::string& entry, const SceneDevice& in,
                        double insertion_mm) {
    if (name == device_name(in) && (name.empty() || entry == in.entry)) return "";
    std::string out = std::string("\n[") + section + "]\nenabled = " + (name.empty() ? "false" : "true") + "\n";
    if (name.empty()) return out;
    out += "device = \"" + name + "\"\nentry = \"" + entry + "\"\n";
    if (!in.enabled) out += "insertion_mm = " + number(insertion_mm) + "\n";
    return out;
}

}  // namespace

std::string difficulty_name(Difficulty difficulty) {
    switch (difficulty) {
        case Difficulty::guided: return "Guided";
        case Difficulty::standard: return "Standard";
        case Difficulty::exam: break;
    }
    return "Exam";
}

std::string difficulty_text(Difficulty difficulty) {
    switch (difficulty) {
        case Difficulty::guided:
            return "the goal is marked, with inner view and a table that follows; force limits a quarter higher";
        case Difficulty::standard: return "inner view and a table that follows; the goal is not marked";
        case Difficulty::exam: break;
    }
    return "fluoroscopy alone, as in the cath lab; force limits a quarter lower";
}

double force_limit_share(Difficulty difficulty) {
    switch (difficulty) {
        case Difficulty::guided: return 1.25;
        case Difficulty::standard: return 1.0;
        case Difficulty::exam: break;
    }
    return 0.75;
}

std::string spoken(std::string name) {
    std::replace(name.begin(), name.end(), '_', ' ');
    return name;
}

Choices find_choices(const std::string& data_root) {
    Choices out;
    out.tasks = all_tasks(data_root, &out.faults);
    out.anatomies = names_in_folder(data_root + "/assets/anatomy", ".toml");
    const std::string devices = data_root + "/assets/devices";
    for (const std::string& name : names_in_folder(devices, ".toml")) {
        try {
            (device_kind(devices + "/" + name + ".toml") == "wire" ? out.wires : out.catheters).push_back(name);
        } catch (const UserError& error) {
            out.faults.emplace_back(error.what());
        }
    }
    for (const EffectInfo& effect : effect_table())
        if (!effect.for_tests && !effect.elastic_wall) out.effects.emplace_back(effect.name);
    return out;
}

std::vector<std::string> entries_of(const std::string& anatomy, const std::string& data_root) {
    std::vector<std::string> out;
    try {
        const TomlNode file = load_toml(data_root + "/assets/anatomy/" + anatomy + ".toml");
        const TomlNode* entries = file.find("entry");
        if (entries == nullptr) return out;
        for (const TomlNode& entry : entries->items)
            if (const TomlNode* name = entry.find("name")) out.push_back(name->text);
    } catch (const UserError&) {
        // The scene itself says what is wrong with its anatomy when it is loaded.
    }
    return out;
}

Setup setup_of(const SceneSpec& scene) {
    Setup out;
    out.scene = scene.path;
    out.overlays = scene.overlays;
    out.anatomy = std::filesystem::path(scene.anatomy.file).stem().string();
    out.entry = scene.wire.enabled ? scene.wire.entry : scene.catheter.entry;
    out.wire = device_name(scene.wire);
    out.catheter = device_name(scene.catheter);
    out.heart = scene.heart.enabled;
    out.heart_rate_bpm = scene.heart.rate_bpm;
    for (const SceneEffect& effect : scene.effects)
        if (effect.enabled) out.effects.emplace_back(effect.info->name);
    return out;
}

void choose_task(const TaskScene& task, Setup& setup) {
    const Difficulty difficulty = setup.difficulty;
    setup = setup_of(task.scene);
    setup.task = task.id;
    setup.difficulty = difficulty;
}

std::string setup_toml(const Setup& setup, const SceneSpec& scene) {
    std::string out;
    if (!setup.anatomy.empty() && setup.anatomy != std::filesystem::path(scene.anatomy.file).stem().string())
        out += "\n[anatomy]\nfile = \"" + setup.anatomy + "\"\n";
    out += device_toml("wire", setup.wire, setup.entry, scene.wire, start_beyond_sheath_mm);
    std::string catheter =
        device_toml("catheter", setup.catheter, setup.entry, scene.catheter, catheter_beyond_sheath_mm);
    if (scene.catheter.follow == "wire" && setup.wire.empty() && !setup.catheter.empty())
        catheter += (catheter.empty() ? "\n[catheter]\n" : "") + std::string("follow = \"vessel\"\n");
    out += catheter;
    if (setup.heart != scene.heart.enabled || (setup.heart && setup.heart_rate_bpm != scene.heart.rate_bpm))
        out += std::string("\n[heart]\nenabled = ") + (setup.heart ? "true" : "false") +
               "\nrate_bpm = " + number(setup.heart_rate_bpm) + "\n";
    for (const EffectInfo& effect : effect_table()) {
        const std::string name(effect.name);
        const bool wanted = std::find(setup.effects.begin(), setup.effects.end(), name) != setup.effects.end();
        if (wanted != switched_on(scene, name))
            out += "\n[effects." + name + "]\nenabled = " + (wanted ? "true" : "false") + "\n";
    }
    if (const double share = force_limit_share(setup.difficulty); share != 1.0)
        out += "\n[wall]\nforce_limit_share = " + number(share * scene.wall.force_limit_share) + "\n";
    return out.empty() ? "" : "# What was chosen on the start screen.\n" + out;
}

}  // namespace cathlab::play
