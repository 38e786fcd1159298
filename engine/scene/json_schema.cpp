#include "scene/json_schema.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "scene/device_file.h"
#include "scene/scene_table.h"

namespace cathlab {
namespace {

using Json = nlohmann::ordered_json;

Json table_schema(const TableSpec& table, const void* defaults);

Json number_schema(const FieldSpec& f, const char* type) {
    Json out{{"type", type}};
    if (std::isfinite(f.range.minimum)) out["minimum"] = f.range.minimum;
    if (std::isfinite(f.range.maximum)) out["maximum"] = f.range.maximum;
    return out;
}

Json list_schema(Json items, std::size_t least, std::size_t most) {
    return {{"type", "array"}, {"items", std::move(items)}, {"minItems", least}, {"maxItems", most}};
}

Json kind_schema(const FieldSpec& f, void* object) {
    switch (f.kind) {
        case FieldKind::number: return number_schema(f, "number");
        case FieldKind::integer: return number_schema(f, "integer");
        case FieldKind::boolean: return {{"type", "boolean"}};
        case FieldKind::text:
        case FieldKind::path: return {{"type", "string"}};
        case FieldKind::choice: return {{"type", "string"}, {"enum", f.choices}};
        case FieldKind::numbers: return list_schema(number_schema(f, "number"), f.count.least, f.count.most);
        case FieldKind::rows:
            return list_schema(list_schema(number_schema(f, "number"), f.width, f.width), f.count.least, f.count.most);
        case FieldKind::texts: return list_schema({{"type", "string"}}, f.count.least, f.count.most);
        case FieldKind::name_or_point:
            return {{"anyOf", {Json{{"type", "string"}}, list_schema(number_schema(f, "number"), 3, 3)}}};
        case FieldKind::table: return table_schema(*f.sub, object == nullptr ? nullptr : f.open(object));
        case FieldKind::tables: {
            const auto defaults = f.sub->make_default();
            return list_schema(table_schema(*f.sub, defaults.get()), f.count.least, f.count.most);
        }
    }
    return {};
}

void add_default(const FieldSpec& f, const void* object, Json& out) {
    if (object == nullptr || f.required || !f.load) return;
    std::visit(
        [&out](const auto& value) {
            if constexpr (!std::is_same_v<std::decay_t<decltype(value)>, std::monostate>) out["default"] = value;
        },
        f.load(object));
}

Json table_schema(const TableSpec& table, const void* defaults) {
    Json out{{"type", "object"}, {"description", table.doc}, {"additionalProperties", false}};
    Json required = Json::array();
    Json& properties = out["properties"] = Json::object();
    for (const FieldSpec& f : table.fields) {
        Json field = kind_schema(f, const_cast<void*>(defaults));
        const bool section = f.kind == FieldKind::table || f.kind == FieldKind::tables;
        if (!section) {
            field["description"] = f.unit.empty() || f.unit == "1" ? f.doc : f.doc + " [" + f.unit + "]";
            add_default(f, defaults, field);
        }
        if (f.required || (f.kind == FieldKind::tables && f.count.least > 0)) required.push_back(f.key);
        properties[f.key] = std::move(field);
    }
    if (!required.empty()) out["required"] = std::move(required);
    return out;
}

Json headed(const std::string& title) {
    return {{"$schema", "https://json-schema.org/draft/2020-12/schema"}, {"title", title}};
}

Json format_schema(const TableSpec& table) {
    const auto defaults = table.make_default();
    return table_schema(table, defaults.get());
}

}  // namespace

std::string json_schema(const TableSpec& table, const std::string& title) {
    Json out = headed(title);
    out.update(format_schema(table));
    return out.dump(2) + "\n";
}

std::string scene_schema_json() {
    return json_schema(scene_table().spec(), "cathlab scene");
}

std::string device_schema_json() {
    Json out = headed("cathlab device");
    out["oneOf"] = {format_schema(wire_table().spec()), format_schema(catheter_table().spec()),
                    format_schema(sleeve_table().spec())};
    return out.dump(2) + "\n";
}

}  // namespace cathlab
