// Strict reading of JSON that a user may have edited.  For the .cpp files of this room alone.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "core/errors.h"
#include "core/hash.h"

namespace cathlab {

/// Throws UserError at `where` when text is not one JSON value.
nlohmann::json parse_json(const std::string& text, const SourcePlace& where);

/// Sixteen hexadecimal digits -> the hash, or nothing.
std::optional<std::uint64_t> parse_hash(std::string_view text);

/// The members of one object, each read once with its type; done() refuses what was not read.
class JsonFields {
public:
    JsonFields(nlohmann::json object, SourcePlace where) : object_(std::move(object)), where_(std::move(where)) {
        if (!object_.is_object()) throw UserError(where_, "an object {...} is wanted");
    }

    template <class T>
    void read(const std::string& key, T& out) {
        const nlohmann::json& value = member(key);
        bool fits = false;
        if constexpr (std::is_same_v<T, bool>)
            fits = value.is_boolean();
        else if constexpr (std::is_floating_point_v<T>)
            fits = value.is_number();
        else if constexpr (std::is_integral_v<T>)
            fits = value.is_number_integer();
        else if constexpr (std::is_same_v<T, std::string>)
            fits = value.is_string();
        else
            fits = all_texts(value);
        if (!fits) throw UserError(place(key), "has the wrong type: found " + shown(value));
        out = value.get<T>();
    }
    void read_hash(const std::string& key, std::uint64_t& out);
    const nlohmann::json& member(const std::string& key);
    bool has(const std::string& key) const { return object_.contains(key); }
    /// Throws UserError naming a member that nobody read.
    void done() const;

private:
    SourcePlace place(const std::string& key) const { return {where_.file, where_.line, key}; }
    static bool all_texts(const nlohmann::json& value);
    static std::string shown(const nlohmann::json& value);

    nlohmann::json object_;
    SourcePlace where_;
    std::set<std::string> read_;
};

}  // namespace cathlab
