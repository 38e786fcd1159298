// A scene file and the overlays over it -> SceneSpec.
#pragma once

#include <string>
#include <vector>

#include "scene/scene_spec.h"

namespace cathlab {

/// Reads a scene, lays the overlays over it in order (tables merge key by key, lists replace), checks every key, every
/// range and what keys must say together, and hashes the content.  Errors name the file that holds the key.
///
/// A path in a file is taken, if relative, from the folder of the file that holds it, and failing that from data_root.
/// A bare name (no slash, no ending) of a device or an anatomy is looked up in data_root/assets/devices, .../anatomy.
///
/// Throws UserError.
SceneSpec load_scene(const std::string& path, const std::vector<std::string>& overlays, const std::string& data_root);

/// The rule above.
PathResolver path_resolver(const std::string& data_root);

/// "scenes/demo.toml" from "demo" or "scenes/demo.toml": as it stands, or under data_root, or by name in
/// data_root/scenes; throws UserError with the nearest scene.
std::string find_scene(const std::string& scene, const std::string& data_root);

/// Names (file names without ending) of the files in a folder with an ending (".toml"), sorted; empty where there is
/// none.
std::vector<std::string> names_in_folder(const std::string& folder, const std::string& ending);

}  // namespace cathlab
