// The tasks of the trainer: assets/tasks/*.toml.
#pragma once

#include <string>
#include <vector>

#include "task/task.h"

namespace cathlab::play {

struct TaskFile {
    std::string id;  ///< the file's name
    std::string title;
    std::string entry;  ///< what the start screen proposes; "" = as it stands
    std::string wire, catheter;
    TaskSpec task;
};

/// Throws UserError: missing, a wrong key, a metric that there is not.
TaskFile load_task(const std::string& path);

/// Those of data_root/assets/tasks, by name; one that cannot be read is left out and said in `faults`.
std::vector<TaskFile> all_tasks(const std::string& data_root, std::vector<std::string>* faults = nullptr);

/// By its id; throws UserError with the nearest.
TaskFile find_task(const std::string& id, const std::string& data_root);

}  // namespace cathlab::play
