// What a window shows: finished pictures in their places, and panels over them.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "imaging/draw_list.h"
#include "imaging/image.h"
#include "render/frame_renderer.h"
#include "render/gl_target.h"

namespace cathlab {

/// A picture and where it stands in the window; of another size than its place it is stretched.
struct WindowPicture {
    const Image8* picture = nullptr;  ///< null or empty: left away
    FrameRect place;
    std::uint64_t revision = 0;  ///< of the picture's content: uploaded again only where this changed
};

/// Use it on one thread.  Draws what FrameRenderer composes, to within 3 of 255 (blended in the window's own order).
class WindowSurface {
public:
    /// own_framebuffer: draw off-screen, for a window that has no GL; otherwise into the target's window.
    /// Throws UserError where the target's OpenGL does not suffice.
    WindowSurface(std::unique_ptr<GlTarget> target, bool own_framebuffer);
    ~WindowSurface();

    /// Pictures in order on black, then the lists in order.  width, height: of the window in pixels, above 0.
    void draw(int width, int height, std::span<const WindowPicture> pictures,
              std::span<const HudDrawList* const> lists);
    /// What was drawn last; for a window, before it is shown.
    void read(Image8& out);
    std::string description() const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace cathlab
