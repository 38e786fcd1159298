#include "play/tasks.h"

#include <filesystem>

#include "core/errors.h"
#include "scene/load_scene.h"
#include "scene/toml_table.h"

namespace cathlab::play {
namespace {

Table<TaskFile> task_file_table() {
    const auto criterion = Table<Criterion>("one number of the score")
                               .text("metric", &Criterion::metric, "cathlab list metrics")
                               .required()
                               .number("full", &Criterion::full, "", {}, "value that gives all of it")
                               .required()
                               .number("none", &Criterion::none, "", {}, "value that gives nothing")
                               .required()
                               .number("weight", &Criterion::weight, "1", {0, 1000}, "share of the score");
    const auto task = Table<TaskSpec>("what is to be reached")
                          .text("instructions", &TaskSpec::instructions, "what the trainee reads")
                          .choice("device", &TaskSpec::device, {"wire", "catheter"}, "whose tip counts")
                          .text("landmark", &TaskSpec::landmark, "of the anatomy")
                          .required()
                          .number("radius_mm", &TaskSpec::radius_mm, "mm", {0.5, 100}, "of the goal's ball")
                          .number("hold_s", &TaskSpec::hold_s, "s", {0, 60}, "how long the tip stays in it")
                          .number("time_limit_s", &TaskSpec::time_limit_s, "s", {1, 7200}, "from the first step")
                          .tables("criterion", &TaskSpec::criteria, criterion);
    return Table<TaskFile>("a task of the trainer")
        .text("title", &TaskFile::title, "one line for the start screen")
        .required()
        .text("entry", &TaskFile::entry, "entry site that it is made for")
        .text("wire", &TaskFile::wire, "guidewire that it is made for")
        .text("catheter", &TaskFile::catheter, "catheter that it is made for")
        .include(&TaskFile::task, task);
}

std::string folder_of(const std::string& data_root) {
    return data_root + "/assets/tasks";
}

}  // namespace

TaskFile load_task(const std::string& path) {
    TaskFile out = read_table(load_toml(path), task_file_table());
    out.id = std::filesystem::path(path).stem().string();
    out.task.name = out.id;
    check_task(out.task);
    return out;
}

std::vector<TaskFile> all_tasks(const std::string& data_root, std::vector<std::string>* faults) {
    std::vector<TaskFile> out;
    for (const std::string& name : names_in_folder(folder_of(data_root), ".toml")) {
        try {
            out.push_back(load_task(folder_of(data_root) + "/" + name + ".toml"));
        } catch (const UserError& error) {
            if (faults != nullptr) faults->emplace_back(error.what());
        }
    }
    return out;
}

TaskFile find_task(const std::string& id, const std::string& data_root) {
    const auto known = names_in_folder(folder_of(data_root), ".toml");
    for (const std::string& name : known)
        if (name == id) return load_task(folder_of(data_root) + "/" + name + ".toml");
    throw UserError("no task '" + id + "'" + did_you_mean(id, known) + " There is: " + comma_list(known), true);
}

}  // namespace cathlab::play
