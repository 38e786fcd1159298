// One ImGui context with its font: input in as plain data, triangles out as plain data, without a window or a clock.
// Between begin() and end() it is the process's current context, so one thread draws all panels.
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <string>

#include "imaging/draw_list.h"

namespace cathlab {

/// Keys that text fields and lists know, in ImGui's order.
enum class UiKey {
    tab,
    left,
    right,
    up,
    down,
    page_up,
    page_down,
    home,
    end,
    insert,
    del,
    backspace,
    space,
    enter,
    escape,
    keypad_enter,
    a,
    c,
    v,
    x,
    y,
    z,
    count
};

/// What a gamepad does in a menu.
enum class UiNav { activate, cancel, left, right, up, down, previous, next, count };

/// What the user does during one frame.  Positions in pixels from the top left; off the window = negative.
struct UiInput {
    float mouse_x = -1e6F, mouse_y = -1e6F;
    std::array<bool, 3> mouse{};  ///< left, right, middle
    float wheel = 0;
    std::array<bool, static_cast<std::size_t>(UiKey::count)> keys{};
    bool shift = false, control = false;
    std::array<float, static_cast<std::size_t>(UiNav::count)> nav{};  ///< 0 to 1
    std::string text;                                                 ///< typed, UTF-8
};

class UiContext {
public:
    /// font_px: height of a line of text, 8 to 96; font_file: a TrueType file, "" = DejaVu Sans where Debian keeps it;
    /// a missing file falls back to the font inside ImGui.  steered: keys and gamepad walk through the widgets.
    UiContext(float font_px, bool steered, const std::string& font_file = "");
    ~UiContext();
    UiContext(const UiContext&) = delete;
    UiContext& operator=(const UiContext&) = delete;

    /// Begins a frame of width x height pixels that stands for dt seconds.
    void begin(float width, float height, float dt = 1.0F / 60.0F, const UiInput& input = {});
    /// Ends it; the same calls in between give the same triangles.
    void end(HudDrawList& out);

    float font_px() const;
    /// Whether a field is being typed into: then keys are letters and steer nothing else.
    bool wants_text() const;
    /// Whether the pointer is over a panel.
    bool wants_mouse() const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace cathlab
