#include "play/source.h"

#include <SDL.h>

#include <array>
#include <utility>
#include <vector>

#include "core/errors.h"

namespace cathlab::play {
namespace {

constexpr std::array<std::pair<const char*, int>, 3> mouse_names{
    {{"left", SDL_BUTTON_LEFT}, {"right", SDL_BUTTON_RIGHT}, {"middle", SDL_BUTTON_MIDDLE}}};

[[noreturn]] void refuse(std::string_view text) {
    throw UserError("'" + std::string(text) +
                    "' is no place on a device; wanted is key:NAME (key:W, key:Left Shift), pad:NAME (leftx, lefty, "
                    "rightx, righty, lefttrigger, righttrigger, a, b, x, y, back, start, leftstick, rightstick, "
                    "leftshoulder, rightshoulder, dpup, dpdown, dpleft, dpright), mouse:left, mouse:right, "
                    "mouse:middle or mouse:wheel, with ':-' after it for the other way");
}

Source pad_source(const std::string& name, std::string_view text) {
    if (const auto axis = SDL_GameControllerGetAxisFromString(name.c_str()); axis != SDL_CONTROLLER_AXIS_INVALID)
        return {Source::Kind::pad_axis, axis, false};
    if (const auto button = SDL_GameControllerGetButtonFromString(name.c_str());
        button != SDL_CONTROLLER_BUTTON_INVALID)
        return {Source::Kind::pad_button, button, false};
    refuse(text);
}

// A stick pushed up gives SDL a negative number.
const char* stick_way(int axis, bool negative) {
    const bool vertical = axis == SDL_CONTROLLER_AXIS_LEFTY || axis == SDL_CONTROLLER_AXIS_RIGHTY;
    if (vertical) return negative ? "up/down" : "down/up";
    return negative ? "left/right" : "right/left";
}

std::string axis_label(int axis, bool negative) {
    switch (axis) {
        case SDL_CONTROLLER_AXIS_LEFTX:
        case SDL_CONTROLLER_AXIS_LEFTY: return std::string("left stick ") + stick_way(axis, negative);
        case SDL_CONTROLLER_AXIS_RIGHTX:
        case SDL_CONTROLLER_AXIS_RIGHTY: return std::string("right stick ") + stick_way(axis, negative);
        case SDL_CONTROLLER_AXIS_TRIGGERLEFT: return "LT";
        default: return "RT";
    }
}

std::string button_label(int button) {
    switch (button) {
        case SDL_CONTROLLER_BUTTON_A: return "A";
        case SDL_CONTROLLER_BUTTON_B: return "B";
        case SDL_CONTROLLER_BUTTON_X: return "X";
        case SDL_CONTROLLER_BUTTON_Y: return "Y";
        case SDL_CONTROLLER_BUTTON_BACK: return "Back";
        case SDL_CONTROLLER_BUTTON_START: return "Start";
        case SDL_CONTROLLER_BUTTON_LEFTSTICK: return "left stick pressed";
        case SDL_CONTROLLER_BUTTON_RIGHTSTICK: return "right stick pressed";
        case SDL_CONTROLLER_BUTTON_LEFTSHOULDER: return "LB";
        case SDL_CONTROLLER_BUTTON_RIGHTSHOULDER: return "RB";
        case SDL_CONTROLLER_BUTTON_DPAD_UP: return "D-pad up";
        case SDL_CONTROLLER_BUTTON_DPAD_DOWN: return "D-pad down";
        case SDL_CONTROLLER_BUTTON_DPAD_LEFT: return "D-pad left";
        case SDL_CONTROLLER_BUTTON_DPAD_RIGHT: return "D-pad right";
        default: {
            const char* name = SDL_GameControllerGetStringForButton(static_cast<SDL_GameControllerButton>(button));
            return name == nullptr ? "?" : name;
        }
    }
}

}  // namespace

Source parse_source(std::string_view text) {
    const auto colon = text.find(':');
    if (colon == std::string_view::npos) refuse(text);
    const std::string_view device = text.substr(0, colon);
    std::string name(text.substr(colon + 1));
    const bool negative = name.size() > 2 && name.ends_with(":-");
    if (negative) name.resize(name.size() - 2);
    Source out;
    if (device == "key") {
        const SDL_Scancode code = SDL_GetScancodeFromName(name.c_str());
        if (code == SDL_SCANCODE_UNKNOWN) refuse(text);
        out = {Source::Kind::key, code, false};
    } else if (device == "pad") {
        out = pad_source(name, text);
    } else if (device == "mouse" && name == "wheel") {
        out.kind = Source::Kind::wheel;
    } else if (device == "mouse") {
        for (const auto& [known, code] : mouse_names)
            if (name == known) out = {Source::Kind::mouse_button, code, false};
    }
    if (out.kind == Source::Kind::none) refuse(text);
    out.negative = negative;
    return out;
}

std::string source_text(const Source& source) {
    std::string text;
    switch (source.kind) {
        case Source::Kind::key:
            text = std::string("key:") + SDL_GetScancodeName(static_cast<SDL_Scancode>(source.code));
            break;
        case Source::Kind::pad_axis:
            text = std::string("pad:") +
                   SDL_GameControllerGetStringForAxis(static_cast<SDL_GameControllerAxis>(source.code));
            break;
        case Source::Kind::pad_button:
            text = std::string("pad:") +
                   SDL_GameControllerGetStringForButton(static_cast<SDL_GameControllerButton>(source.code));
            break;
        case Source::Kind::mouse_button:
            for (const auto& [known, code] : mouse_names)
                if (source.code == code) text = std::string("mouse:") + known;
            break;
        case Source::Kind::wheel: text = "mouse:wheel"; break;
        case Source::Kind::none: return "";
    }
    return source.negative ? text + ":-" : text;
}

std::string source_label(const Source& source) {
    switch (source.kind) {
        case Source::Kind::key: return SDL_GetScancodeName(static_cast<SDL_Scancode>(source.code));
        case Source::Kind::pad_axis: return axis_label(source.code, source.negative);
        case Source::Kind::pad_button: return button_label(source.code);
        case Source::Kind::mouse_button:
            for (const auto& [known, code] : mouse_names)
                if (source.code == code) return std::string(known) + " mouse button";
            return "?";
        case Source::Kind::wheel: return "mouse wheel";
        case Source::Kind::none: break;
    }
    return "";
}

}  // namespace cathlab::play
