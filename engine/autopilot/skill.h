// How good a made operator is.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace cathlab {

/// The numbers are assumptions: they order operators, they were not measured on people.
struct Skill {
    std::string_view name;
    double reaction_s;  ///< what is seen and felt is so old
    double speed_mm_s;  ///< largest advance
    double easy;        ///< force bar up to which it pushes as if nothing were
    double caution;     ///< force bar at which it pushes no more; above 1 it waits for the alarm
    double tremor;      ///< relative noise of every speed
    double near_mm;     ///< begins to slow down so far from the goal
    std::string_view doc;
};

/// expert, intermediate, novice.
std::span<const Skill> skill_table();

/// Throws UserError with the nearest known name.
const Skill& find_skill(const std::string& name);

}  // namespace cathlab
