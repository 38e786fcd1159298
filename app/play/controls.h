// What a hand can do, whatever device it uses.  The manifest is controls.inl.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

namespace cathlab::play {

enum class Control : std::size_t {
#define CATHLAB_CONTROL(name, kind, label, doc, ...) name,
#include "play/controls.inl"
#undef CATHLAB_CONTROL
    count
};
inline constexpr std::size_t control_count = static_cast<std::size_t>(Control::count);

enum class ControlKind { axis, hold, press };

struct ControlInfo {
    Control control;
    std::string_view name;
    ControlKind kind;
    std::string_view label;
    std::string_view doc;
    std::span<const std::string_view> sources;  ///< at first, as text
};

/// In the order of controls.inl.
std::span<const ControlInfo> control_table();

/// What the hands do now.
struct Controls {
    std::array<double, control_count> value{};           ///< axis: -1 to 1; hold and press: 0 to 1
    std::array<std::uint32_t, control_count> presses{};  ///< how often each was pressed since the start

    double& operator[](Control c) { return value[static_cast<std::size_t>(c)]; }
    double operator[](Control c) const { return value[static_cast<std::size_t>(c)]; }
    std::uint32_t pressed(Control c) const { return presses[static_cast<std::size_t>(c)]; }
};

}  // namespace cathlab::play
