// One place on a device that a finger moves: a key, a stick, a trigger, a button, the wheel.
#pragma once

#include <compare>
#include <string>
#include <string_view>

namespace cathlab::play {

struct Source {
    enum class Kind { none, key, pad_axis, pad_button, mouse_button, wheel };
    Kind kind = Kind::none;
    int code = 0;           ///< SDL's scancode, controller axis, controller button or mouse button
    bool negative = false;  ///< it moves its control the other way

    auto operator<=>(const Source&) const = default;
    bool of_pad() const { return kind == Kind::pad_axis || kind == Kind::pad_button; }
};

/// "key:W", "key:Left Shift", "pad:leftx", "pad:a", "mouse:left", "mouse:wheel"; ":-" at the end turns it round.
/// Throws UserError with what there is.
Source parse_source(std::string_view text);
std::string source_text(const Source& source);

/// As a person says it: "W", "left stick up", "RT", "A", "right mouse button".
std::string source_label(const Source& source);

}  // namespace cathlab::play
