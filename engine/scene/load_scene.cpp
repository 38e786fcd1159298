#include "scene/load_scene.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>

#include "beam/view_presets.h"
#include "core/hash.h"
#include "scene/scene_table.h"

namespace cathlab {
namespace fs = std::filesystem;
namespace {

std::string missing_file(const std::string& text, const std::vector<fs::path>& tried) {
    std::vector<std::string> places;
    for (const fs::path& p : tried) {
        const std::string place = p.lexically_normal().string();
        if (std::find(places.begin(), places.end(), place) == places.end()) places.push_back(place);
    }
    return "no such file '" + text + "'; looked for " + comma_list(places);
}

std::string resolve_path(const std::string& data_root, const std::string& text, const std::string& library,
                         const SourcePlace& where) {
    if (text.empty()) throw UserError(where, "the path is empty");
    const fs::path path(text);
    const fs::path root(data_root);
    if (!library.empty() && path.filename() == path && !path.has_extension()) {
        const fs::path in_library = root / library / (text + ".toml");
        if (fs::is_regular_file(in_library)) return in_library.lexically_normal().string();
        const auto known = names_in_folder((root / library).string(), ".toml");
        throw UserError(
            where, "no '" + text + "' in " + library + did_you_mean(text, known) + " There is: " + comma_list(known));
    }
    std::vector<fs::path> tried;
    if (path.is_absolute())
        tried = {path};
    else
        tried = {fs::path(where.file).parent_path() / path, root / path};
    for (const fs::path& candidate : tried)
        if (fs::is_regular_file(candidate)) return candidate.lexically_normal().string();
    for (const fs::path& candidate : tried)
        if (fs::exists(candidate)) throw UserError(where, "'" + text + "' is no file");
    throw UserError(where, missing_file(text, tried));
}

void check_names(const std::string& section, const std::vector<ImportedEntry>& entries) {
    std::set<std::string> seen;
    for (const ImportedEntry& entry : entries)
        if (!seen.insert(entry.name).second)
            throw UserError(entry.where, "a second " + section + " named '" + entry.name + "'");
}

void check_anatomy(const SceneAnatomy& anatomy) {
    const bool mesh = !anatomy.imported.mesh.empty();
    if (mesh == !anatomy.file.empty())
        throw UserError(anatomy.where, mesh ? "has both 'file' and 'mesh'; one of them is wanted"
                                            : "needs 'file' (a parametric anatomy) or 'mesh' (an imported one)");
    if (mesh && anatomy.imported.entries.empty())
        throw UserError(anatomy.where, "a mesh needs at least one [[anatomy.entry]] with name and near");
    if (mesh && !anatomy.stenoses.empty())
        throw UserError(anatomy.stenoses.front().where,
                        "a stenosis can be put into a parametric anatomy alone, not into a mesh");
    if (!mesh && !(anatomy.imported.entries.empty() && anatomy.imported.fixed.empty() && !anatomy.imported.annulus))
        throw UserError(anatomy.where,
                        "'entry', 'fixed' and 'annulus' belong to a mesh; a parametric file has its own");
    check_names("[[anatomy.entry]]", anatomy.imported.entries);
    check_names("[[anatomy.landmark]]", anatomy.imported.landmarks);
}

void check_device(const SceneDevice& device, const char* section) {
    if (device.enabled && device.device.empty())
        throw UserError(device.where, std::string("the ") + section + " is enabled but names no 'device'");
}

void check_heart(const SceneHeart& heart) {
    for (std::size_t i = 0; i < heart.profile.size(); ++i) {
        const double phase = heart.profile[i][0];
        if (phase < 0.0 || phase >= 1.0 || (i > 0 && phase <= heart.profile[i - 1][0]))
            throw UserError(heart.where,
                            "profile: the phases must rise from 0 to below 1 (row " + std::to_string(i + 1) + ")");
    }
    if (heart.profile.size() == 1) throw UserError(heart.where, "profile: at least two rows are wanted");
}

void check_scene(const SceneSpec& scene) {
    check_anatomy(scene.anatomy);
    check_device(scene.wire, "wire");
    check_device(scene.catheter, "catheter");
    if (scene.catheter.enabled && scene.catheter.follow == "wire" && !scene.wire.enabled)
        throw UserError(scene.catheter.where,
                        "follow = \"wire\" but there is no wire: [wire] enabled = true is wanted");
    check_heart(scene.heart);
    if (scene.c_arm.sod_mm >= scene.c_arm.sid_mm)
        throw UserError(scene.c_arm.where, "sod_mm (source to isocentre) must be below sid_mm (source to detector)");
    if (!scene.c_arm.view.empty() && find_view(scene.c_arm.view) == nullptr)
        throw UserError(scene.c_arm.where, "view: no view '" + scene.c_arm.view + "'" +
                                               did_you_mean(scene.c_arm.view, view_names()) +
                                               " There is: " + comma_list(view_names()));
    if (!scene.c_arm.view.empty() && (scene.c_arm.primary_deg != 0.0 || scene.c_arm.secondary_deg != 0.0))
        throw UserError(scene.c_arm.where, "has both a view and angles; one of them is wanted");
    const double rate = scene.c_arm.frame_rate;
    if (rate != 7.5 && rate != 15.0 && rate != 30.0)
        throw UserError(scene.c_arm.where, "frame_rate: 7.5, 15 or 30 is wanted");
    if (scene.video.width % 2 != 0 || scene.video.height % 2 != 0)
        throw UserError({scene.path, 0, "[video]"}, "width and height must be even");
    for (const SceneEffect& effect : scene.effects)
        if (effect.enabled && effect.info->elastic_wall && scene.wall.form != "elastic")
            throw UserError({scene.path, 0, "[effects." + std::string(effect.info->name) + "]"},
                            "acts on an elastic wall alone: [wall] form = \"elastic\" is wanted");
    std::set<std::string> seen;
    for (const SceneWallRegion& region : scene.wall.regions)
        if (!seen.insert(region.name).second)
            throw UserError(region.where, "a second region named '" + region.name + "'");
}

}  // namespace

PathResolver path_resolver(const std::string& data_root) {
    return [data_root](const std::string& text, const std::string& library, const SourcePlace& where) {
        return resolve_path(data_root, text, library, where);
    };
}

std::vector<std::string> names_in_folder(const std::string& folder, const std::string& ending) {
    std::vector<std::string> names;
    std::error_code error;
    for (const auto& entry : fs::directory_iterator(folder, error))
        if (entry.path().extension() == ending) names.push_back(entry.path().stem().string());
    std::sort(names.begin(), names.end());
    return names;
}

std::string find_scene(const std::string& scene, const std::string& data_root) {
    const fs::path root(data_root);
    const std::vector<fs::path> candidates{scene, root / scene, root / "scenes" / (scene + ".toml")};
    for (const fs::path& candidate : candidates)
        if (fs::is_regular_file(candidate)) return candidate.string();
    if (fs::is_directory(scene)) throw UserError(scene + ": is a folder, a scene file is wanted");
    const auto known = names_in_folder((root / "scenes").string(), ".toml");
    const std::string near = did_you_mean(fs::path(scene).stem().string(), known);
    throw UserError("no scene '" + scene + "'" + near +
                    (known.empty() ? "" : (near.empty() ? "; there is: " : " There is: ") + comma_list(known)));
}

SceneSpec load_scene(const std::string& path, const std::vector<std::string>& overlays, const std::string& data_root) {
    TomlNode document = load_toml(path);
    for (const std::string& overlay : overlays) merge_toml(document, load_toml(overlay));

    SceneSpec scene;
    scene.path = path;
    scene.overlays = overlays;
    read_table(document, scene_table().spec(), &scene, path_resolver(data_root));
    if (scene.name.empty()) scene.name = fs::path(path).stem().string();
    check_scene(scene);
    if (const ViewPreset* view = find_view(scene.c_arm.view)) {
        scene.c_arm.primary_deg = view->primary_deg;
        scene.c_arm.secondary_deg = view->secondary_deg;
    }

    Hash64 hash;
    hash.text(canonical_text(document));
    for (const std::string& file :
         {scene.anatomy.file, scene.anatomy.imported.mesh, scene.wire.device, scene.catheter.device})
        if (!file.empty()) hash.word(hash_file(file));
    scene.hash = hash.value();
    return scene;
}

}  // namespace cathlab
