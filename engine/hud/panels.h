// The panels, in ImGui calls alone: the off-screen frame and the window draw the same.
#pragma once

#include "hud/hud_data.h"

namespace cathlab {

/// Where the panels may stand, pixels of the picture; scale 1 = readable at 1024 x 512.
struct HudLayout {
    float width = 1024;
    float height = 512;
    float split = 512;  ///< the fluoroscopy ends here; text on grey at its left, bars at its right
    float scale = 1;    ///< 0.75 to 2.5
};

/// A rectangle in pixels from the top left.
struct HudRect {
    float x0 = 0, y0 = 0, x1 = 0, y1 = 0;
};

/// The trough of force bar number `index` (the bar fills it from the left to force / limit of its width).
HudRect force_bar_rect(const HudLayout& layout, std::size_t count, std::size_t index);

/// Draws everything into the current ImGui frame.
void draw_panels(const HudData& data, const HudLayout& layout);

}  // namespace cathlab
