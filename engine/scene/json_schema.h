// JSON Schema (2020-12) of the file formats, for editors; made from the tables that parse.
#pragma once

#include <string>

#include "scene/toml_table.h"

namespace cathlab {

/// The schema of one format as indented JSON with a final newline.
std::string json_schema(const TableSpec& table, const std::string& title);

/// Of scene files: docs/scene.schema.json.
std::string scene_schema_json();
/// Of device files, either kind: docs/device.schema.json.
std::string device_schema_json();

}  // namespace cathlab
