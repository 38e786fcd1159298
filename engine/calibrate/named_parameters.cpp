#include "calibrate/named_parameters.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <sstream>

#include "core/check.h"
#include "core/errors.h"
#include "scene/scene_table.h"

namespace cathlab {
namespace {

struct Found {
    NamedParameter named;
    const FieldSpec* field = nullptr;
    std::vector<const FieldSpec*> tables;  // on the way to it
};

void walk(const TableSpec& spec, const std::string& prefix, std::vector<const FieldSpec*>& tables,
          const std::function<void(const Found&)>& see) {
    for (const FieldSpec& field : spec.fields) {
        const std::string path = prefix.empty() ? field.key : prefix + "." + field.key;
        if (field.kind == FieldKind::number)
            see({{path, field.unit, field.range.minimum, field.range.maximum}, &field, tables});
        // How a rig loads a wall is no property of what a world simulates.
        if (field.kind != FieldKind::table || !field.sub || path == "rig") continue;
        tables.push_back(&field);
        walk(*field.sub, path, tables, see);
        tables.pop_back();
    }
}

std::vector<Found> all() {
    std::vector<Found> out;
    std::vector<const FieldSpec*> tables;
    walk(scene_table().spec(), "", tables, [&](const Found& found) { out.push_back(found); });
    return out;
}

std::string with_unit(const std::string& text, const NamedParameter& named) {
    return named.unit == "1" ? text : text + " " + named.unit;
}

Found find(const std::string& path) {
    std::vector<std::string> known;
    for (const Found& found : all()) {
        if (found.named.path == path) return found;
        known.push_back(found.named.path);
    }
    throw UserError("a scene has no number '" + path + "'" + did_you_mean(path, known));
}

/// The effect and parameter of "effects.NAME.KEY"; nullptr for any other path.
SceneEffect* effect_of(SceneSpec& scene, const std::string& path, std::size_t& parameter) {
    constexpr std::string_view prefix = "effects.";
    if (!path.starts_with(prefix)) return nullptr;
    for (SceneEffect& effect : scene.effects) {
        const std::string start = std::string(prefix) + std::string(effect.info->name) + ".";
        if (!path.starts_with(start)) continue;
        for (parameter = 0; parameter < effect.info->parameters.size(); ++parameter)
            if (path.substr(start.size()) == effect.info->parameters[parameter].key) return &effect;
    }
    return nullptr;
}

std::string number_text(double value) {
    std::ostringstream out;
    out.precision(9);
    out << value;
    const std::string text = out.str();
    return text + (text.find_first_of(".e") == std::string::npos ? ".0" : "");
}

}  // namespace

std::vector<NamedParameter> named_parameters() {
    std::vector<NamedParameter> out;
    for (const Found& found : all()) out.push_back(found.named);
    return out;
}

NamedParameter find_named_parameter(const std::string& path) {
    return find(path).named;
}

double get_named(const SceneSpec& scene, const std::string& path) {
    SceneSpec copy = scene;  // a table's open() wants an object that it may write to
    const Found found = find(path);
    std::size_t parameter = 0;
    if (const SceneEffect* effect = effect_of(copy, path, parameter)) return effect->values.at(parameter);
    void* object = &copy;
    for (const FieldSpec* table : found.tables) object = table->open(object);
    const auto value = found.field->load(object);
    if (const double* number = std::get_if<double>(&value)) return *number;
    throw UserError("the scene does not say " + path + ", so there is nothing to begin from; write it there");
}

void set_named(SceneSpec& scene, const std::string& path, double value) {
    const Found found = find(path);
    if (!std::isfinite(value) || value < found.named.minimum || value > found.named.maximum)
        throw UserError(path + " = " + number_text(value) + "; allowed: " + number_text(found.named.minimum) + " to " +
                        with_unit(number_text(found.named.maximum), found.named));
    std::size_t parameter = 0;
    if (SceneEffect* effect = effect_of(scene, path, parameter)) {
        effect->values.at(parameter) = value;
        effect->enabled = true;
        return;
    }
    void* object = &scene;
    for (const FieldSpec* table : found.tables) object = table->open(object);
    found.field->store(object, value);
}

Bound named_bound(const std::string& path) {
    const NamedParameter named = find_named_parameter(path);
    return named_bound(path, named.minimum, named.maximum);
}

Bound named_bound(const std::string& path, double lower, double upper) {
    const NamedParameter named = find_named_parameter(path);
    const std::string range = number_text(lower) + " to " + number_text(upper);
    if (!std::isfinite(lower) || !std::isfinite(upper))
        throw UserError(path + ": the range " + range + " must be finite");
    if (lower > upper) throw UserError(path + ": the range " + range + " is turned round");
    if (lower < named.minimum || upper > named.maximum)
        throw UserError(path + ": the range " + range + " leaves what a scene allows, " + number_text(named.minimum) +
                        " to " + with_unit(number_text(named.maximum), named));
    return {lower, upper, path};
}

std::string overlay_text(std::span<const std::string> paths, std::span<const double> values) {
    CATHLAB_CHECK(paths.size() == values.size(), "one value a path");
    std::vector<std::string> order;  // sections as they come
    std::vector<std::string> bodies;
    for (std::size_t i = 0; i < paths.size(); ++i) {
        const auto dot = paths[i].rfind('.');
        const std::string section = dot == std::string::npos ? "" : paths[i].substr(0, dot);
        const std::string key = dot == std::string::npos ? paths[i] : paths[i].substr(dot + 1);
        auto place = static_cast<std::size_t>(std::find(order.begin(), order.end(), section) - order.begin());
        if (place == order.size()) {
            // Keys without a section must stand before the first one.
            place = section.empty() ? 0 : place;
            order.insert(order.begin() + static_cast<std::ptrdiff_t>(place), section);
            bodies.insert(bodies.begin() + static_cast<std::ptrdiff_t>(place),
                          section.starts_with("effects.") ? "enabled = true\n" : "");
        }
        bodies[place] += key + " = " + number_text(values[i]) + "\n";
    }
    std::string out;
    for (std::size_t i = 0; i < order.size(); ++i)
        out += (out.empty() ? "" : "\n") + (order[i].empty() ? "" : "[" + order[i] + "]\n") + bodies[i];
    return out;
}

}  // namespace cathlab
