// A TOML file as a plain tree in which every node knows its file and line.  toml++ stays behind the .cpp.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/errors.h"

namespace cathlab {

enum class TomlKind { table, array, text, integer, number, boolean, other };

struct TomlMember;

struct TomlNode {
    TomlKind kind = TomlKind::table;
    std::shared_ptr<const std::string> file;
    int line = 0;      ///< where the value stands; 0 = unknown
    int key_line = 0;  ///< where its key stands

    std::vector<TomlMember> members;  ///< of a table, sorted by key
    std::vector<TomlNode> items;      ///< of an array
    std::string text;                 ///< of a text; of `other` (a date, a time) its TOML form
    std::int64_t integer = 0;
    double number = 0.0;  ///< of a number or an integer
    bool boolean = false;

    /// The member of a table, or nullptr.
    const TomlNode* find(const std::string& key) const;
    SourcePlace place(const std::string& key = "") const;
    /// "the text 'abc'", "the integer 3", "a table": what was found, for sentences.
    std::string describe() const;
};

struct TomlMember {
    std::string key;
    TomlNode node;
};

/// Reads a TOML file of at most 16 MB; throws UserError with file:line where it is missing, a folder, not text, not
/// TOML, holds a key twice or nests deeper than 64 levels.
TomlNode load_toml(const std::string& path);

/// The same from text; `file` is the name that errors show.
TomlNode parse_toml(const std::string& text, const std::string& file);

/// Lays `overlay` over `base`: tables merge key by key, anything else (arrays too) replaces.  Nodes keep their file and
/// line.
void merge_toml(TomlNode& base, TomlNode overlay);

/// The content alone in one canonical form (no file, line, order or comment): equal text = equal document.
std::string canonical_text(const TomlNode& node);

/// The whole of a text file of at most `most_bytes`; throws UserError (missing, folder, too large, not text).
std::string read_text_file(const std::string& path, std::uint64_t most_bytes);

}  // namespace cathlab
