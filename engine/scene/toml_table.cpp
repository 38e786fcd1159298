#include "scene/toml_table.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <sstream>

namespace cathlab {
namespace {

std::string number_text(double value) {
    std::ostringstream out;
    out.precision(std::fabs(value) < 1e15 ? 15 : 17);
    out << value;
    return out.str();
}

std::string range_text(const FieldSpec& f) {
    const bool low = std::isfinite(f.range.minimum);
    const bool high = std::isfinite(f.range.maximum);
    std::string out;
    if (low && high)
        out = " from " + number_text(f.range.minimum) + " to " + number_text(f.range.maximum);
    else if (low)
        out = " of at least " + number_text(f.range.minimum);
    else if (high)
        out = " of at most " + number_text(f.range.maximum);
    if (!f.unit.empty() && f.unit != "1") out += (out.empty() ? " in " : " ") + f.unit;
    return out;
}

std::string count_text(const FieldSpec& f) {
    if (f.count.least == f.count.most) return std::to_string(f.count.least);
    return std::to_string(f.count.least) + " to " + std::to_string(f.count.most);
}

std::string wanted(const FieldSpec& f) {
    switch (f.kind) {
        case FieldKind::number: return "a number" + range_text(f);
        case FieldKind::integer: return "a whole number" + range_text(f);
        case FieldKind::boolean: return "true or false";
        case FieldKind::text: return "a text in quotes";
        case FieldKind::choice: return "one of " + comma_list(f.choices);
        case FieldKind::path:
            return f.library.empty() ? "a path in quotes" : "a name in " + f.library + " or a path, in quotes";
        case FieldKind::numbers: return "a list of " + count_text(f) + " numbers" + range_text(f);
        case FieldKind::rows:
            return "a list of " + count_text(f) + " rows of " + std::to_string(f.width) + " numbers" + range_text(f);
        case FieldKind::texts: return "a list of " + count_text(f) + " texts";
        case FieldKind::name_or_point: return "a name in quotes or three numbers" + range_text(f);
        case FieldKind::table: return "a section [" + f.key + "]";
        case FieldKind::tables: return "sections [[" + f.key + "]], " + count_text(f) + " of them";
    }
    return "";
}

[[noreturn]] void refuse(const TomlNode& node, const FieldSpec& f, const std::string& name, const std::string& found) {
    throw UserError(node.place(name), "found " + found + "; " + wanted(f) + " is wanted");
}

double read_number(const TomlNode& node, const FieldSpec& f, const std::string& name) {
    if (node.kind != TomlKind::number && node.kind != TomlKind::integer) refuse(node, f, name, node.describe());
    if (!std::isfinite(node.number) || node.number < f.range.minimum || node.number > f.range.maximum)
        refuse(node, f, name, node.describe());
    return node.number;
}

std::vector<double> read_numbers(const TomlNode& node, const FieldSpec& f, const std::string& name, std::size_t least,
                                 std::size_t most) {
    if (node.kind != TomlKind::array || node.items.size() < least || node.items.size() > most)
        refuse(node, f, name, node.describe());
    std::vector<double> out;
    out.reserve(node.items.size());
    for (const TomlNode& item : node.items) out.push_back(read_number(item, f, name));
    return out;
}

FieldValue read_value(const TomlNode& node, const FieldSpec& f, const std::string& name, const PathResolver& resolve) {
    switch (f.kind) {
        case FieldKind::number: return read_number(node, f, name);
        case FieldKind::integer:
            if (node.kind != TomlKind::integer) refuse(node, f, name, node.describe());
            read_number(node, f, name);
            return node.integer;
        case FieldKind::boolean:
            if (node.kind != TomlKind::boolean) refuse(node, f, name, node.describe());
            return node.boolean;
        case FieldKind::text:
            if (node.kind != TomlKind::text) refuse(node, f, name, node.describe());
            return node.text;
        case FieldKind::choice:
            if (node.kind != TomlKind::text) refuse(node, f, name, node.describe());
            if (std::find(f.choices.begin(), f.choices.end(), node.text) == f.choices.end())
                throw UserError(node.place(name), "found " + node.describe() + "; " + wanted(f) + " is wanted" +
                                                      did_you_mean(node.text, f.choices));
            return node.text;
        case FieldKind::path:
            if (node.kind != TomlKind::text) refuse(node, f, name, node.describe());
            return resolve(node.text, f.library, node.place(name));
        case FieldKind::numbers: return read_numbers(node, f, name, f.count.least, f.count.most);
        case FieldKind::rows: {
            if (node.kind != TomlKind::array || node.items.size() < f.count.least || node.items.size() > f.count.most)
                refuse(node, f, name, node.describe());
            std::vector<double> flat;
            for (const TomlNode& row : node.items) {
                const auto numbers = read_numbers(row, f, name, f.width, f.width);
                flat.insert(flat.end(), numbers.begin(), numbers.end());
            }
            return flat;
        }
        case FieldKind::texts: {
            if (node.kind != TomlKind::array || node.items.size() < f.count.least || node.items.size() > f.count.most)
                refuse(node, f, name, node.describe());
            std::vector<std::string> out;
            for (const TomlNode& item : node.items) {
                if (item.kind != TomlKind::text) refuse(item, f, name, item.describe());
                out.push_back(item.text);
            }
            return out;
        }
        case FieldKind::name_or_point:
            if (node.kind == TomlKind::text && !node.text.empty()) return node.text;
            return read_numbers(node, f, name, 3, 3);
        case FieldKind::table:
        case FieldKind::tables: break;
    }
    return std::monostate{};
}

std::string subsection(const std::string& section, const std::string& key) {
    return section.empty() ? key : section + "." + key;
}

void read_tables(const TomlNode& node, const FieldSpec& f, void* object, const PathResolver& resolve,
                 const std::string& section) {
    const std::string name = subsection(section, f.key);
    if (node.kind != TomlKind::array || node.items.size() < f.count.least || node.items.size() > f.count.most)
        refuse(node, f, name, node.describe());
    f.clear(object);
    int number = 0;
    for (const TomlNode& item : node.items) {
        if (item.kind != TomlKind::table) refuse(item, f, name, item.describe());
        read_table(item, *f.sub, f.open(object), resolve, name + " " + std::to_string(++number));
    }
}

}  // namespace

void read_table(const TomlNode& node, const TableSpec& spec, void* object, const PathResolver& resolve,
                const std::string& section) {
    const std::string prefix = section.empty() ? "" : "[" + section + "] ";
    for (const auto& [key, value] : node.members) {
        if (std::any_of(spec.fields.begin(), spec.fields.end(),
                        [&key = key](const FieldSpec& f) { return f.key == key; }))
            continue;
        std::vector<std::string> known;
        for (const FieldSpec& f : spec.fields)
            if (!f.unlisted) known.push_back(f.key);
        const SourcePlace where{value.file ? *value.file : "", value.key_line, prefix + key};
        throw UserError(where, "no such key" + did_you_mean(key, known) +
                                   (nearest_name(key, known).empty() ? "; " : " ") +
                                   "Known here: " + comma_list(known));
    }
    if (spec.store_place) spec.store_place(object, node.place(section.empty() ? "" : "[" + section + "]"));
    for (const FieldSpec& f : spec.fields) {
        const TomlNode* value = node.find(f.key);
        if (value == nullptr) {
            const bool missing = f.required || (f.kind == FieldKind::tables && f.count.least > 0);
            if (missing) throw UserError(node.place(prefix + f.key), "is missing; " + wanted(f) + " is wanted");
            continue;
        }
        if (f.kind == FieldKind::table) {
            if (value->kind != TomlKind::table) refuse(*value, f, prefix + f.key, value->describe());
            read_table(*value, *f.sub, f.open(object), resolve, subsection(section, f.key));
        } else if (f.kind == FieldKind::tables) {
            read_tables(*value, f, object, resolve, section);
        } else {
            f.store(object, read_value(*value, f, prefix + f.key, resolve));
        }
    }
}

std::string resolve_beside_file(const std::string& text, const std::string&, const SourcePlace& where) {
    const std::filesystem::path path(text);
    const auto full = path.is_absolute() ? path : std::filesystem::path(where.file).parent_path() / path;
    if (!std::filesystem::exists(full)) throw UserError(where, "no such file: " + full.lexically_normal().string());
    return full.lexically_normal().string();
}

std::vector<double> parameter_defaults(std::span<const Parameter> list) {
    std::vector<double> out;
    for (const Parameter& p : list) out.push_back(p.default_value);
    return out;
}

}  // namespace cathlab
