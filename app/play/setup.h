// What a trainee chooses before the start, and the overlay over a scene that it becomes.
#pragma once

#include <string>
#include <vector>

#include "play/tasks.h"
#include "scene/scene_spec.h"

namespace cathlab::play {

/// How much help there is.
enum class Difficulty { guided, standard, exam };
std::string difficulty_name(Difficulty difficulty);
/// What it means, in one line.
std::string difficulty_text(Difficulty difficulty);
/// Of the force limits of the wall.
double force_limit_share(Difficulty difficulty);

struct Setup {
    std::string scene;  ///< path of the scene that is laid under
    std::vector<std::string> overlays;
    std::string task;  ///< id, "" = free play
    std::string anatomy, entry;
    std::string wire, catheter;  ///< device names, "" = none
    bool heart = true;
    double heart_rate_bpm = 67.0;
    std::vector<std::string> effects;  ///< switched on, with their defaults
    Difficulty difficulty = Difficulty::standard;
};

/// What there is to choose from.
struct Choices {
    std::vector<TaskScene> tasks;
    std::vector<std::string> anatomies, wires, catheters, effects;
    std::vector<std::string> faults;
};
Choices find_choices(const std::string& data_root);
/// Entry sites of a parametric anatomy, by name; empty where it cannot be read.
std::vector<std::string> entries_of(const std::string& anatomy, const std::string& data_root);

/// What the scene itself says.
Setup setup_of(const SceneSpec& scene);
/// Lays a task under it; how much help there is stays.
void choose_task(const TaskScene& task, Setup& setup);

/// The overlay (TOML).  Only what differs from the scene stands in it, so that a choice that was not made changes
/// nothing.  "" where nothing differs.
std::string setup_toml(const Setup& setup, const SceneSpec& scene);

/// "right_femoral" -> "right femoral"
std::string spoken(std::string name);

}  // namespace cathlab::play
