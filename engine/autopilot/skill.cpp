#include "autopilot/skill.h"

#include <array>
#include <vector>

#include "core/errors.h"

namespace cathlab {

std::span<const Skill> skill_table() {
    static constexpr std::array table{
        Skill{"expert", 0.2, 14.0, 0.5, 0.85, 0.05, 25.0, 1.0, 4.0, 0.5, 1.0, 4.0,
              "sees early, pushes softly, keeps off the wall, slows down before the goal"},
        Skill{"intermediate", 0.35, 14.0, 0.65, 1.0, 0.15, 18.0, 2.0, 2.0, 1.0, 4.0, 2.0, "between the two"},
        Skill{"novice", 0.6, 10.0, 0.9, 1.4, 0.4, 10.0, 2.5, 1.2, 1.7, 7.0, 0.0,
              "late, in fits and starts, takes long to see a wrong branch, guesses the depth, and pushes until the "
              "alarm"},
    };
    return table;
}

const Skill& find_skill(const std::string& name) {
    std::vector<std::string> known;
    for (const Skill& skill : skill_table()) {
        if (skill.name == name) return skill;
        known.emplace_back(skill.name);
    }
    const std::string near = did_you_mean(name, known);
    throw UserError(
        "no skill '" + name + "'" + near + (near.empty() ? "; there is: " : " There is: ") + comma_list(known), true);
}

}  // namespace cathlab
