#include "autopilot/skill.h"

#include <array>
#include <vector>

#include "core/errors.h"

namespace cathlab {

std::span<const Skill> skill_table() {
    static constexpr std::array table{
        Skill{"expert", 0.2, 25.0, 0.5, 0.85, 0.05, 60.0, "sees early, pushes softly, slows down before the goal"},
        Skill{"intermediate", 0.35, 25.0, 0.65, 1.0, 0.15, 40.0, "between the two"},
        Skill{"novice", 0.6, 30.0, 0.9, 1.4, 0.4, 15.0, "late, fast, and pushes until the alarm"},
    };
    return table;
}

const Skill& find_skill(const std::string& name) {
    std::vector<std::string> known;
    for (const Skill& skill : skill_table()) {
        if (skill.name == name) return skill;
        known.emplace_back(skill.name);
    }
    throw UserError("no skill '" + name + "'" + did_you_mean(name, known) + " There is: " + comma_list(known), true);
}

}  // namespace cathlab
