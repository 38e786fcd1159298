// cathlab list: what there is to choose from.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "beam/materials.h"
#include "beam/view_presets.h"
#include "commands.h"
#include "core/channels.h"
#include "core/errors.h"
#include "core/input.h"
#include "effects/effect.h"
#include "scene/device_file.h"
#include "scene/json_schema.h"
#include "scene/load_scene.h"
#include "task/metrics.h"

namespace cathlab {
namespace {

using Json = nlohmann::ordered_json;

// One text of a TOML file for a list; a file that cannot be read is listed with its fault.
Json toml_entry(const std::string& folder, const std::string& name, const char* key, const char* second_key) {
    Json out{{"name", name}};
    try {
        const TomlNode file = load_toml(folder + "/" + name + ".toml");
        for (const char* wanted : {key, second_key}) {
            const TomlNode* value = file.find(wanted);
            out[wanted] = value != nullptr && value->kind == TomlKind::text ? value->text : "";
        }
    } catch (const UserError& error) {
        out["fault"] = error.what();
    }
    return out;
}

Json list_folder(const std::string& folder, const char* key, const char* second_key) {
    Json out = Json::array();
    for (const std::string& name : names_in_folder(folder, ".toml"))
        out.push_back(toml_entry(folder, name, key, second_key));
    return out;
}

Json list_effects() {
    Json out = Json::array();
    for (const EffectInfo& e : effect_table()) {
        if (e.for_tests) continue;
        Json parameters = Json::array();
        for (const Parameter& p : e.parameters)
            parameters.push_back({{"key", p.key},
                                  {"unit", p.unit},
                                  {"default", p.default_value},
                                  {"minimum", p.minimum},
                                  {"maximum", p.maximum},
                                  {"doc", p.doc}});
        out.push_back({{"name", e.name},
                       {"doc", e.doc},
                       {"source", e.source},
                       {"hooks", hook_names(e.hooks)},
                       {"parameters", std::move(parameters)}});
    }
    return out;
}

template <class Infos>
Json list_infos(const Infos& infos) {
    Json out = Json::array();
    for (const auto& info : infos) out.push_back({{"name", info.name}, {"unit", info.unit}, {"doc", info.doc}});
    return out;
}

Json list_materials() {
    Json out = Json::array();
    for (const Material& m : material_table())
        out.push_back({{"name", m.name}, {"density_g_cm3", m.density_g_cm3}, {"source", m.source}, {"doc", m.doc}});
    return out;
}

Json list_views() {
    Json out = Json::array();
    for (const ViewPreset& v : view_presets())
        out.push_back(
            {{"name", v.name}, {"primary_deg", v.primary_deg}, {"secondary_deg", v.secondary_deg}, {"shows", v.shows}});
    return out;
}

std::string cell(const Json& value) {
    return value.is_string() ? value.get<std::string>() : value.dump();
}

// Columns of equal width; nested lists (an effect's parameters) come on lines of their own.
void print_table(const Json& rows) {
    std::vector<std::size_t> widths;
    for (const Json& row : rows) {
        std::size_t column = 0;
        for (const auto& [key, value] : row.items()) {
            if (value.is_array()) continue;
            widths.resize(std::max(widths.size(), column + 1));
            widths[column] = std::max(widths[column], cell(value).size());
            ++column;
        }
    }
    for (const Json& row : rows) {
        std::string line;
        std::size_t column = 0;
        for (const auto& [key, value] : row.items()) {
            if (value.is_array()) continue;
            const std::string text = cell(value);
            line += text + std::string(widths[column] - text.size() + 2, ' ');
            ++column;
        }
        line.erase(line.find_last_not_of(' ') + 1);
        std::printf("%s\n", line.c_str());
        if (!row.contains("parameters")) continue;
        for (const Json& p : row["parameters"])
            std::printf("    %s = %s %s (%s to %s)  %s\n", cell(p["key"]).c_str(), cell(p["default"]).c_str(),
                        cell(p["unit"]).c_str(), cell(p["minimum"]).c_str(), cell(p["maximum"]).c_str(),
                        cell(p["doc"]).c_str());
    }
}

void list(const std::string& what, bool json, const AppContext& context) {
    if (what == "schema" || what == "device-schema") {
        std::fputs((what == "schema" ? scene_schema_json() : device_schema_json()).c_str(), stdout);
        return;
    }
    Json rows;
    if (what == "scenes") rows = list_folder(context.data_root + "/scenes", "title", "name");
    if (what == "devices") rows = list_folder(context.data_root + "/assets/devices", "kind", "source");
    if (what == "anatomies") rows = list_folder(context.data_root + "/assets/anatomy", "name", "source");
    if (what == "effects") rows = list_effects();
    if (what == "channels") rows = list_infos(channel_table());
    if (what == "actions") rows = list_infos(action_table());
    if (what == "views") rows = list_views();
    if (what == "metrics") rows = list_infos(metric_table());
    if (what == "materials") rows = list_materials();
    if (json)
        std::printf("%s\n", rows.dump(2, ' ', false, Json::error_handler_t::replace).c_str());
    else
        print_table(rows);
}

}  // namespace

void add_list_command(CLI::App& app, AppContext& context) {
    struct Options {
        std::string what;
        bool json = false;
    };
    const auto options = std::make_shared<Options>();
    CLI::App* command = app.add_subcommand("list", "Show what there is to choose from");
    command
        ->add_option("WHAT", options->what,
                     "scenes, devices, effects, channels, materials, anatomies, actions, views, metrics, schema or "
                     "device-schema")
        ->required()
        ->check(CLI::IsMember({"scenes", "devices", "effects", "channels", "materials", "anatomies", "actions", "views",
                               "metrics", "schema", "device-schema"}));
    command->add_flag("--json", options->json, "As JSON");
    command->callback([options, &context] { list(options->what, options->json, context); });
}

}  // namespace cathlab
