// What an operator does, as a table of rows: CSV `t_s,action,value` with the actions of core/actions.inl.
//
//     t_s,action,value
//     # comments and empty lines are allowed
//     0.0,device,wire
//     0.5,advance,30
//     8.0,proximal_bend,45
//
// Between rows a value is held or goes in a straight line to the action's next row, as the action's interpolation says.
// Before its first row an action has its base value; after its last row it keeps that row's value.  Of two rows of one
// action at one time the later counts (a jump).  Rows stand in order of time.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "core/input.h"
#include "scene/scene_spec.h"

namespace cathlab {

class Script {
public:
    /// A script without rows: the base all the time.
    Script();
    /// Throws UserError with file:line (missing header, unknown action, text for a number, NaN, out of range, time that
    /// runs back or is negative or beyond a day).
    static Script load(const std::string& path);
    static Script parse(const std::string& text, const std::string& file);

    /// The input at t seconds; where the script is silent, `base` speaks (the scene's C-arm angles, say).
    Input at(double t, const Input& base = {}) const;
    /// Time of the last row, s; 0 without rows.
    double end_s() const { return end_s_; }
    std::size_t row_count() const;

private:
    std::vector<std::vector<std::pair<double, double>>> rows_;  // one list an action, in the order of action_table()
    double end_s_ = 0.0;
};

/// What holds until an operator says otherwise: the C-arm's angles and the dose as the scene has them.
Input base_input(const SceneSpec& scene);

}  // namespace cathlab
