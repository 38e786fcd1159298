// The description of a scene file: every key with its unit, range and doc.  docs/scene.schema.json is written from it.
#pragma once

#include "scene/scene_spec.h"
#include "scene/toml_table.h"

namespace cathlab {

const Table<SceneSpec>& scene_table();

}  // namespace cathlab
