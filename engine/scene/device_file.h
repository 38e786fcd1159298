// Device files (assets/devices/*.toml): kind = "wire" -> WireSpec, "catheter" -> CatheterSpec, "passive_catheter" ->
// SleeveSpec.
#pragma once

#include <string>

#include "catheter/spec.h"
#include "rod/sleeve_spec.h"
#include "rod/wire_spec.h"
#include "scene/toml_table.h"

namespace cathlab {

/// "wire", "catheter" or "passive_catheter"; throws UserError for any other file.
std::string device_kind(const std::string& path);

/// Throw UserError with file:line: wrong kind, unknown keys, wrong types, values out of range.
WireSpec load_wire(const std::string& path);
CatheterSpec load_catheter(const std::string& path);
SleeveSpec load_sleeve(const std::string& path);

/// The formats, for the JSON Schema.
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
struct SleeveFile {
    int schema = 1;
    std::string kind = "passive_catheter";
    SleeveSpec spec;
};
const Table<WireFile>& wire_table();
const Table<CatheterFile>& catheter_table();
const Table<SleeveFile>& sleeve_table();

}  // namespace cathlab
