#include "core/input.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace cathlab {

std::span<const ActionInfo> action_table() {
    static constexpr std::array table{
#define CATHLAB_ACTION(name, unit, interpolation, default_value, least, most, doc) \
    ActionInfo{#name, unit, Interpolation::interpolation, default_value, least, most, doc, &Input::name},
#include "core/actions.inl"
#undef CATHLAB_ACTION
    };
    return table;
}

const ActionInfo* find_action(std::string_view name) {
    for (const ActionInfo& a : action_table())
        if (a.name == name) return &a;
    return nullptr;
}

Input in_range(const Input& wanted) {
    Input input = wanted;
    for (const ActionInfo& action : action_table()) {
        double& value = input.*action.value;
        if (!std::isfinite(value)) value = action.default_value;
        value = std::clamp(value, action.minimum, action.maximum);
    }
    return input;
}

}  // namespace cathlab
