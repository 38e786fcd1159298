// Keys, buttons and sticks as they stand -> what the hands do.
#pragma once

#include <SDL_events.h>

#include <array>
#include <optional>
#include <vector>

#include "play/bindings.h"
#include "play/controls.h"
#include "play/settings.h"
#include "play/stick.h"

namespace cathlab::play {

/// Fed with events alone, never with the devices' own state, so that a test's events count as a hand's.
class InputState {
public:
    /// Takes what concerns it (keys, mouse buttons, wheel, controller axes and buttons, a controller that goes, a
    /// window that loses the keyboard).  over_panel: the pointer is over a panel; typing: letters go into a text field.
    void feed(const SDL_Event& event, bool over_panel = false, bool typing = false);

    /// The screens are drawn anew: what was held on them counts no more.
    void screens_begin() { on_screen_.fill(0.0); }
    /// A control that is held with the mouse on the screen, until they are drawn again.
    void hold(Control control, double value);
    /// ... or pressed once.
    void press(Control control);

    /// The values and presses that follow from what was fed.  The wheel counts once.
    const Controls& evaluate(const Settings& settings);

    /// Everything of the pad, or of the keyboard and the mouse, is let go.
    void release_pad();
    void release_keys();

    /// While it waits for a place to be bound: the next key, button, or stick that is moved far, instead of its effect.
    /// Escape gives it up.
    void listen(bool yes);
    bool listening() const { return listening_; }
    std::optional<Source> heard();

    /// For plots: where the sticks are, raw, in [-1, 1].
    StickPlace left_stick() const;
    StickPlace right_stick() const;

private:
    double value_of(const Source& source, const Settings& settings) const;
    double pad_axis(int axis, const Settings& settings) const;

    std::array<bool, SDL_NUM_SCANCODES> keys_{};
    std::array<bool, 8> mouse_{};
    std::array<double, SDL_CONTROLLER_AXIS_MAX> axes_{};
    std::array<bool, SDL_CONTROLLER_BUTTON_MAX> buttons_{};
    std::array<bool, SDL_NUM_SCANCODES> key_tapped_{};  // pressed since the last frame, even if let go since
    std::array<bool, 8> mouse_tapped_{};
    std::array<bool, SDL_CONTROLLER_BUTTON_MAX> button_tapped_{};
    double wheel_ = 0.0;
    std::array<double, control_count> on_screen_{};
    std::array<bool, control_count> was_down_{};
    Controls controls_;
    bool listening_ = false;
    std::optional<Source> heard_;
};

}  // namespace cathlab::play
