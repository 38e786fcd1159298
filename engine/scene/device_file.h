// Device files (assets/devices/*.toml): kind = "wire" -> WireSpec, kind = "catheter" -> CatheterSpec.
#pragma once

#include <string>

#include "catheter/spec.h"
#include "rod/wire_spec.h"
#include "scene/toml_table.h"

namespace cathlab {

/// "wire" or "catheter"; throws UserError for any other file.
std::string device_kind(const std::string& path);

/// Throw UserError with file:line: wrong kind, unknown keys, wrong types, values out of range.
WireSpec load_wire(const std::string& path);
CatheterSpec load_catheter(const std::string& path);

/// The two formats, for the JSON Schema.
struct WireFile {
    int schema = 1;
    std::string kind = "wire";
    WireSpec spec;
};
struct CatheterFile {
    int schema = 1;
    std::string kind = "catheter";
    CatheterSpec spec;
};
const Table<WireFile>& wire_table();
const Table<CatheterFile>& catheter_table();

}  // namespace cathlab
