// How good a made operator is.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace cathlab {

/// The numbers are assumptions: they order operators, they were not measured on people.  docs/studies.md says what each
/// stands for.
struct Skill {
    std::string_view name;
    double reaction_s;  ///< what is seen and felt is so old
    double speed_mm_s;  ///< largest advance
    double easy;        ///< force bar up to which it pushes as if nothing were
    double caution;     ///< force bar at which it pushes no more; above 1 it waits for the alarm
    double tremor;      ///< relative noise of every speed
    double near_mm;     ///< begins to slow down so far from the goal
    double notice_s;    ///< of pushing until a wrong branch, or that it does not get on, is recognised
    double moves_s;     ///< mean time for which the hand moves before it rests ...
    double looks_s;     ///< ... and mean time for which it then rests, and the picture is looked at
    double depth_mm;    ///< standard deviation of what is guessed along the beam, where a projection shows nothing
    double room_mm;     ///< that it plans to leave between the catheter and the wall
    std::string_view doc;
};

/// expert, intermediate, novice.
std::span<const Skill> skill_table();

/// Throws UserError with the nearest known name.
const Skill& find_skill(const std::string& name);

}  // namespace cathlab
