// What the operator does during one step.  The manifest is actions.inl; a script, a gamepad and a program fill the same
// struct.
#pragma once

#include <span>
#include <string_view>

namespace cathlab {

struct Input {
#define CATHLAB_ACTION(name, unit, interpolation, default_value, least, most, doc) double name = default_value;
#include "core/actions.inl"
#undef CATHLAB_ACTION
};

enum class Interpolation { hold, linear };

struct ActionInfo {
    std::string_view name;
    std::string_view unit;
    Interpolation interpolation;
    double default_value;
    double minimum;
    double maximum;
    std::string_view doc;
    double Input::*value;
};

/// In the order of actions.inl.
std::span<const ActionInfo> action_table();

/// nullptr where there is none of that name.
const ActionInfo* find_action(std::string_view name);

/// As a step takes it and a run records it: what is not a number is the action's default, what is out of range its
/// limit.
Input in_range(const Input& wanted);

}  // namespace cathlab
