#include "scene/toml_document.h"

#include <toml++/toml.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string_view>

namespace cathlab {
namespace {

constexpr std::uint64_t most_toml_bytes = 16ULL << 20U;
constexpr int deepest = 64;

using FileName = std::shared_ptr<const std::string>;

TomlNode convert(const toml::node& source, const FileName& file);

TomlNode convert_table(const toml::table& source, const FileName& file) {
    TomlNode out;
    for (const auto& [key, value] : source) {
        TomlNode node = convert(value, file);
        node.key_line = static_cast<int>(key.source().begin.line);
        if (node.line == 0) node.line = node.key_line;
        out.members.push_back({std::string(key.str()), std::move(node)});
    }
    std::sort(out.members.begin(), out.members.end(), [](const auto& a, const auto& b) { return a.key < b.key; });
    return out;
}

TomlNode convert(const toml::node& source, const FileName& file) {
    TomlNode out;
    if (const auto* table = source.as_table()) {
        out = convert_table(*table, file);
    } else if (const auto* array = source.as_array()) {
        out.kind = TomlKind::array;
        for (const toml::node& item : *array) out.items.push_back(convert(item, file));
    } else if (const auto* text = source.as_string()) {
        out.kind = TomlKind::text;
        out.text = text->get();
    } else if (const auto* integer = source.as_integer()) {
        out.kind = TomlKind::integer;
        out.integer = integer->get();
        out.number = static_cast<double>(out.integer);
    } else if (const auto* number = source.as_floating_point()) {
        out.kind = TomlKind::number;
        out.number = number->get();
    } else if (const auto* boolean = source.as_boolean()) {
        out.kind = TomlKind::boolean;
        out.boolean = boolean->get();
    } else {
        out.kind = TomlKind::other;
        std::ostringstream form;
        form << toml::node_view<const toml::node>(source);
        out.text = form.str();
    }
    out.file = file;
    out.line = static_cast<int>(source.source().begin.line);
    return out;
}

// A key of a hundred thousand dots would nest tables until the stack overflows, before any later check could see it.
void refuse_endless_keys(const std::string& text, const std::string& file) {
    int line = 1;
    int dots = 0;
    for (const char c : text) {
        if (c == '\n') ++line;
        if (std::string_view("=,[]{}\n").find(c) != std::string_view::npos) dots = 0;
        if (c == '.' && ++dots > deepest)
            throw UserError({file, line, ""}, "a key of more than " + std::to_string(deepest) + " dotted parts");
    }
}

std::string number_text(double value) {
    std::array<char, 64> buffer{};
    const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value).ptr;
    return {buffer.data(), end};
}

void write_canonical(const TomlNode& node, std::string& out) {
    switch (node.kind) {
        case TomlKind::table:
            out += '{';
            for (const auto& [key, value] : node.members) {
                out += std::to_string(key.size()) + ':' + key + '=';
                write_canonical(value, out);
            }
            out += '}';
            break;
        case TomlKind::array:
            out += '[';
            for (const TomlNode& item : node.items) write_canonical(item, out);
            out += ']';
            break;
        case TomlKind::text: out += 't' + std::to_string(node.text.size()) + ':' + node.text; break;
        case TomlKind::integer:
        case TomlKind::number: out += 'n' + number_text(node.number) + ';'; break;  // 2 and 2.0 say the same
        case TomlKind::boolean: out += node.boolean ? "b1" : "b0"; break;
        case TomlKind::other: out += 'o' + node.text + ';'; break;
    }
}

}  // namespace

const TomlNode* TomlNode::find(const std::string& key) const {
    for (const auto& [name, node] : members)
        if (name == key) return &node;
    return nullptr;
}

SourcePlace TomlNode::place(const std::string& key) const {
    return {file ? *file : std::string(), line, key};
}

std::string TomlNode::describe() const {
    switch (kind) {
        case TomlKind::table: return "a table";
        case TomlKind::array: return "a list of " + std::to_string(items.size());
        case TomlKind::text: return "the text '" + (text.size() > 60 ? text.substr(0, 57) + "..." : text) + "'";
        case TomlKind::integer: return std::to_string(integer);
        case TomlKind::number: return number_text(number);
        case TomlKind::boolean: return boolean ? "true" : "false";
        case TomlKind::other: return "the date or time " + text;
    }
    return "";
}

std::string read_text_file(const std::string& path, std::uint64_t most_bytes) {
    std::error_code error;
    const auto status = std::filesystem::status(path, error);
    if (!std::filesystem::exists(status)) throw UserError(path + ": no such file");
    if (std::filesystem::is_directory(status)) throw UserError(path + ": is a folder, a file is wanted");
    std::ifstream in(path, std::ios::binary);
    if (!in) throw UserError(path + ": cannot be read");
    std::string text;
    std::array<char, 65536> buffer{};
    while (in.read(buffer.data(), static_cast<std::streamsize>(buffer.size())) || in.gcount() > 0) {
        text.append(buffer.data(), static_cast<std::size_t>(in.gcount()));
        if (text.size() > most_bytes)
            throw UserError(path + ": larger than the " + std::to_string(most_bytes >> 20U) +
                            " MB allowed for such a file");
    }
    const auto nul = text.find('\0');
    if (nul != std::string::npos) {
        const auto line = 1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(nul), '\n');
        throw UserError({path, static_cast<int>(line), ""}, "is not a text file (it holds a zero byte)");
    }
    return text;
}

TomlNode parse_toml(const std::string& text, const std::string& file) {
    refuse_endless_keys(text, file);
    try {
        const toml::table table = toml::parse(text, file);
        return convert(table, std::make_shared<const std::string>(file));
    } catch (const toml::parse_error& error) {
        throw UserError({file, static_cast<int>(error.source().begin.line), ""},
                        "is not valid TOML: " + std::string(error.description()));
    }
}

TomlNode load_toml(const std::string& path) {
    return parse_toml(read_text_file(path, most_toml_bytes), path);
}

void merge_toml(TomlNode& base, TomlNode overlay) {
    for (TomlMember& member : overlay.members) {
        const auto at = std::lower_bound(base.members.begin(), base.members.end(), member.key,
                                         [](const TomlMember& m, const std::string& key) { return m.key < key; });
        if (at == base.members.end() || at->key != member.key)
            base.members.insert(at, std::move(member));
        else if (at->node.kind == TomlKind::table && member.node.kind == TomlKind::table)
            merge_toml(at->node, std::move(member.node));
        else
            at->node = std::move(member.node);
    }
}

std::string canonical_text(const TomlNode& node) {
    std::string out;
    write_canonical(node, out);
    return out;
}

}  // namespace cathlab
