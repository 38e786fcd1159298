#include "play/input_state.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace cathlab::play {
namespace {

constexpr double down = 0.5;   // from here on a hold counts as pressed
constexpr double far = 0.7;    // a stick that is to be bound is moved at least so far
constexpr double notch = 1.0;  // a notch of the wheel, as a share of full deflection

std::size_t at(int index) {
    return static_cast<std::size_t>(index);
}

int mirrored_axis(int axis) {
    switch (axis) {
        case SDL_CONTROLLER_AXIS_LEFTX: return SDL_CONTROLLER_AXIS_RIGHTX;
        case SDL_CONTROLLER_AXIS_LEFTY: return SDL_CONTROLLER_AXIS_RIGHTY;
        case SDL_CONTROLLER_AXIS_RIGHTX: return SDL_CONTROLLER_AXIS_LEFTX;
        case SDL_CONTROLLER_AXIS_RIGHTY: return SDL_CONTROLLER_AXIS_LEFTY;
        case SDL_CONTROLLER_AXIS_TRIGGERLEFT: return SDL_CONTROLLER_AXIS_TRIGGERRIGHT;
        case SDL_CONTROLLER_AXIS_TRIGGERRIGHT: return SDL_CONTROLLER_AXIS_TRIGGERLEFT;
        default: return axis;
    }
}

int mirrored_button(int button) {
    switch (button) {
        case SDL_CONTROLLER_BUTTON_LEFTSTICK: return SDL_CONTROLLER_BUTTON_RIGHTSTICK;
        case SDL_CONTROLLER_BUTTON_RIGHTSTICK: return SDL_CONTROLLER_BUTTON_LEFTSTICK;
        case SDL_CONTROLLER_BUTTON_LEFTSHOULDER: return SDL_CONTROLLER_BUTTON_RIGHTSHOULDER;
        case SDL_CONTROLLER_BUTTON_RIGHTSHOULDER: return SDL_CONTROLLER_BUTTON_LEFTSHOULDER;
        default: return button;
    }
}

// A place that is bound while the program listens; the way in which a stick was moved becomes the positive one.
std::optional<Source> source_of(const SDL_Event& event) {
    switch (event.type) {
        case SDL_KEYDOWN: return Source{Source::Kind::key, event.key.keysym.scancode, false};
        case SDL_CONTROLLERBUTTONDOWN: return Source{Source::Kind::pad_button, event.cbutton.button, false};
        case SDL_CONTROLLERAXISMOTION:
            if (std::abs(event.caxis.value) < far * 32767) return std::nullopt;
            return Source{Source::Kind::pad_axis, event.caxis.axis, event.caxis.value < 0};
        case SDL_MOUSEWHEEL: return Source{Source::Kind::wheel, 0, event.wheel.y < 0};
        case SDL_MOUSEBUTTONDOWN:
            if (event.button.button == SDL_BUTTON_LEFT) return std::nullopt;  // it works the panels
            return Source{Source::Kind::mouse_button, event.button.button, false};
        default: return std::nullopt;
    }
}

}  // namespace

void InputState::feed(const SDL_Event& event, bool over_panel, bool typing) {
    if (listening_) {
        const auto source = source_of(event);
        if (!source) return;
        listening_ = false;
        if (*source != Source{Source::Kind::key, SDL_SCANCODE_ESCAPE, false}) heard_ = source;
        release_keys();
        release_pad();
        return;
    }
    switch (event.type) {
        case SDL_KEYDOWN:
            if (event.key.repeat != 0 || typing) break;
            keys_[at(event.key.keysym.scancode)] = key_tapped_[at(event.key.keysym.scancode)] = true;
            break;
        case SDL_KEYUP: keys_[at(event.key.keysym.scancode)] = false; break;
        case SDL_MOUSEBUTTONDOWN:
            if (!over_panel && event.button.button < mouse_.size())
                mouse_[event.button.button] = mouse_tapped_[event.button.button] = true;
            break;
        case SDL_MOUSEBUTTONUP:
            if (event.button.button < mouse_.size()) mouse_[event.button.button] = false;
            break;
        case SDL_MOUSEWHEEL:
            if (!over_panel) wheel_ += notch * event.wheel.y;
            break;
        case SDL_CONTROLLERAXISMOTION:
            if (event.caxis.axis < axes_.size())
                axes_[event.caxis.axis] = std::clamp(event.caxis.value / 32767.0, -1.0, 1.0);
            break;
        case SDL_CONTROLLERBUTTONDOWN:
            if (event.cbutton.button < buttons_.size())
                buttons_[event.cbutton.button] = button_tapped_[event.cbutton.button] = true;
            break;
        case SDL_CONTROLLERBUTTONUP:
            if (event.cbutton.button < buttons_.size()) buttons_[event.cbutton.button] = false;
            break;
        case SDL_CONTROLLERDEVICEREMOVED: release_pad(); break;
        case SDL_WINDOWEVENT:
            if (event.window.event == SDL_WINDOWEVENT_FOCUS_LOST) release_keys();
            break;
        default: break;
    }
}

void InputState::hold(Control control, double value) {
    on_screen_[static_cast<std::size_t>(control)] = value;
}

void InputState::press(Control control) {
    ++controls_.presses[static_cast<std::size_t>(control)];
}

double InputState::pad_axis(int axis, const Settings& settings) const {
    if (settings.input.left_handed) axis = mirrored_axis(axis);
    const StickShape& shape = settings.input.stick;
    switch (axis) {
        case SDL_CONTROLLER_AXIS_LEFTX: return shaped(shape, left_stick()).x;
        case SDL_CONTROLLER_AXIS_LEFTY: return shaped(shape, left_stick()).y;
        case SDL_CONTROLLER_AXIS_RIGHTX: return shaped(shape, right_stick()).x;
        case SDL_CONTROLLER_AXIS_RIGHTY: return shaped(shape, right_stick()).y;
        default: return shaped({shape.dead_zone, shape.outer_zone, 1.0}, axes_[at(axis)]);
    }
}

double InputState::value_of(const Source& source, const Settings& settings) const {
    double value = 0.0;
    switch (source.kind) {
        case Source::Kind::key: value = keys_[at(source.code)] || key_tapped_[at(source.code)] ? 1.0 : 0.0; break;
        case Source::Kind::mouse_button:
            value = mouse_[at(source.code)] || mouse_tapped_[at(source.code)] ? 1.0 : 0.0;
            break;
        case Source::Kind::pad_axis: value = pad_axis(source.code, settings); break;
        case Source::Kind::pad_button: {
            const int button = settings.input.left_handed ? mirrored_button(source.code) : source.code;
            value = buttons_[at(button)] || button_tapped_[at(button)] ? 1.0 : 0.0;
            break;
        }
        case Source::Kind::wheel: value = wheel_; break;
        case Source::Kind::none: break;
    }
    return source.negative ? -value : value;
}

const Controls& InputState::evaluate(const Settings& settings) {
    for (const ControlInfo& info : control_table()) {
        const auto i = static_cast<std::size_t>(info.control);
        double value = on_screen_[i];
        for (const Source& source : settings.bindings.of(info.control)) value += value_of(source, settings);
        const double least = info.kind == ControlKind::axis ? -1.0 : 0.0;
        value = std::clamp(value, least, 1.0);
        const bool is_down = value > down;
        if (is_down && !was_down_[i]) ++controls_.presses[i];
        was_down_[i] = is_down;
        controls_.value[i] = value;
    }
    wheel_ = 0.0;
    key_tapped_.fill(false);
    mouse_tapped_.fill(false);
    button_tapped_.fill(false);
    return controls_;
}

void InputState::release_pad() {
    axes_.fill(0.0);
    buttons_.fill(false);
    button_tapped_.fill(false);
}

void InputState::release_keys() {
    keys_.fill(false);
    key_tapped_.fill(false);
    mouse_.fill(false);
    mouse_tapped_.fill(false);
    wheel_ = 0.0;
}

void InputState::listen(bool yes) {
    listening_ = yes;
    heard_.reset();
}

std::optional<Source> InputState::heard() {
    return std::exchange(heard_, std::nullopt);
}

StickPlace InputState::left_stick() const {
    return {axes_[SDL_CONTROLLER_AXIS_LEFTX], axes_[SDL_CONTROLLER_AXIS_LEFTY]};
}

StickPlace InputState::right_stick() const {
    return {axes_[SDL_CONTROLLER_AXIS_RIGHTX], axes_[SDL_CONTROLLER_AXIS_RIGHTY]};
}

}  // namespace cathlab::play
