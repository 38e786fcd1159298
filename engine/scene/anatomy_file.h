// Anatomies as TOML files: assets/anatomy/*.toml, and the [anatomy] section of a scene for an imported mesh.
#pragma once

#include <string>

#include "anatomy/spec.h"
#include "scene/toml_table.h"

namespace cathlab {

/// What stands in an anatomy file, described once.
const Table<AnatomySpec>& anatomy_table();

/// The sections that describe an imported mesh (mesh, unit, [[entry]], [[fixed]], [[landmark]], [annulus], walls).
const Table<ImportedAnatomySpec>& imported_anatomy_table();

/// Reads and validates an anatomy file (schema = 1); throws UserError with file:line.
AnatomySpec load_anatomy(const std::string& path);

}  // namespace cathlab
