// The tasks that the trainer offers: the scenes of scenes/tasks.
#pragma once

#include <string>
#include <vector>

#include "scene/scene_spec.h"
#include "task/task.h"

namespace cathlab::play {

/// A scene that sets a task.
struct TaskScene {
    std::string id;     ///< the scene's name
    std::string title;  ///< one line for the start screen
    SceneSpec scene;
    TaskSpec task;
};

/// Throws UserError: the scene is wrong, or sets no task.
TaskScene load_task(const std::string& path, const std::string& data_root);

/// Those of data_root/scenes/tasks, the shortest first; one that cannot be read is left out and said in `faults`.
std::vector<TaskScene> all_tasks(const std::string& data_root, std::vector<std::string>* faults = nullptr);

/// By the file's name; throws UserError with the nearest.
TaskScene find_task(const std::string& id, const std::string& data_root);

}  // namespace cathlab::play
