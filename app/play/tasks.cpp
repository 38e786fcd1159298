#include "play/tasks.h"

#include <algorithm>

#include "core/errors.h"
#include "scene/load_scene.h"
#include "task/scene_task.h"

namespace cathlab::play {
namespace {

std::string folder_of(const std::string& data_root) {
    return data_root + "/scenes/tasks";
}

}  // namespace

TaskScene load_task(const std::string& path, const std::string& data_root) {
    TaskScene out;
    out.scene = load_scene(path, {}, data_root);
    const auto task = task_of(out.scene);
    if (!task) throw UserError(path + ": sets no [task]");
    out.task = *task;
    out.id = out.scene.name;
    out.title = out.scene.title.empty() ? out.id : out.scene.title;
    return out;
}

std::vector<TaskScene> all_tasks(const std::string& data_root, std::vector<std::string>* faults) {
    std::vector<TaskScene> out;
    for (const std::string& name : names_in_folder(folder_of(data_root), ".toml")) {
        try {
            out.push_back(load_task(folder_of(data_root) + "/" + name + ".toml", data_root));
        } catch (const UserError& error) {
            if (faults != nullptr) faults->emplace_back(error.what());
        }
    }
    std::stable_sort(out.begin(), out.end(),
                     [](const TaskScene& a, const TaskScene& b) { return a.task.time_limit_s < b.task.time_limit_s; });
    return out;
}

TaskScene find_task(const std::string& id, const std::string& data_root) {
    const auto known = names_in_folder(folder_of(data_root), ".toml");
    if (std::find(known.begin(), known.end(), id) == known.end())
        throw UserError("no task '" + id + "'" + did_you_mean(id, known) + " There is: " + comma_list(known), true);
    return load_task(folder_of(data_root) + "/" + id + ".toml", data_root);
}

}  // namespace cathlab::play
