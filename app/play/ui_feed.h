// SDL's events -> what the panels take.
#pragma once

#include <SDL_events.h>

#include "hud/ui_context.h"

namespace cathlab::play {

class UiFeed {
public:
    /// scale: pixels of the drawing a unit of the window (1 but on high-density screens).
    void feed(const SDL_Event& event, float scale_x, float scale_y);
    /// The state for one frame; what lasts no longer (wheel, text, taps) is then forgotten.
    UiInput take();
    /// Lets go of everything: another window has the keyboard, or another screen came.
    void release();

private:
    UiInput input_;
    std::array<bool, 3> tapped_{};
    std::array<bool, static_cast<std::size_t>(UiKey::count)> key_tapped_{};
    std::array<float, static_cast<std::size_t>(UiNav::count)> nav_tapped_{}, stick_{};
};

}  // namespace cathlab::play
