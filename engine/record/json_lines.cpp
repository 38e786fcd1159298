#include "record/json_lines.h"

#include <algorithm>

namespace cathlab {

nlohmann::json parse_json(const std::string& text, const SourcePlace& where) {
    int depth = 0;  // the parser would recurse as deep as the text nests
    for (const char c : text) {
        if ((c == '{' || c == '[') && ++depth > 64)
            throw UserError(where, "is no JSON of this program: nests too deep");
        if (c == '}' || c == ']') --depth;
    }
    nlohmann::json out = nlohmann::json::parse(text, nullptr, false);
    if (out.is_discarded()) throw UserError(where, "is not valid JSON (truncated or edited?)");
    return out;
}

std::optional<std::uint64_t> parse_hash(std::string_view text) {
    if (text.size() != 16) return std::nullopt;
    std::uint64_t out = 0;
    for (const char c : text) {
        const bool digit = c >= '0' && c <= '9';
        if (!digit && !(c >= 'a' && c <= 'f')) return std::nullopt;
        out = out * 16U + static_cast<std::uint64_t>(digit ? c - '0' : c - 'a' + 10);
    }
    return out;
}

const nlohmann::json& JsonFields::member(const std::string& key) {
    const auto it = object_.find(key);
    if (it == object_.end()) throw UserError(place(key), "is missing");
    read_.insert(key);
    return *it;
}

void JsonFields::read_hash(const std::string& key, std::uint64_t& out) {
    const nlohmann::json& value = member(key);
    const auto hash = value.is_string() ? parse_hash(value.get<std::string>()) : std::nullopt;
    if (!hash) throw UserError(place(key), "found " + shown(value) + "; sixteen hexadecimal digits are wanted");
    out = *hash;
}

void JsonFields::done() const {
    for (const auto& [key, value] : object_.items())
        if (!read_.contains(key))
            throw UserError(place(key), "no such key" + did_you_mean(key, {read_.begin(), read_.end()}));
}

bool JsonFields::all_texts(const nlohmann::json& value) {
    return value.is_array() &&
           std::all_of(value.begin(), value.end(), [](const auto& item) { return item.is_string(); });
}

std::string JsonFields::shown(const nlohmann::json& value) {
    const std::string text = value.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
    return text.size() > 60 ? text.substr(0, 57) + "..." : text;
}

}  // namespace cathlab
