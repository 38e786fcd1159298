// Panels -> triangles, without a window: one ImGui context an object, no file, no clock.
#pragma once

#include <memory>
#include <string>

#include "hud/hud_data.h"
#include "hud/panels.h"
#include "imaging/draw_list.h"

namespace cathlab {

class Hud {
public:
    /// scale in [0.5, 4]; font_file: a TrueType file, "" = DejaVu Sans where Debian keeps it; a missing file falls back
    /// to the font inside ImGui.
    explicit Hud(float scale = 1.0F, const std::string& font_file = "");
    ~Hud();
    Hud(const Hud&) = delete;
    Hud& operator=(const Hud&) = delete;

    /// Lays the panels out for a picture of layout.width x layout.height; the same data give the same triangles.
    /// layout.scale is replaced by this HUD's scale.
    void draw(const HudData& data, HudLayout layout, HudDrawList& out);
    float scale() const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace cathlab
