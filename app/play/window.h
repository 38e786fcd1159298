// The window: SDL's, drawn with OpenGL where there is some, else drawn off-screen and copied.
#pragma once

#include <memory>
#include <span>
#include <string>

#include "imaging/image.h"
#include "render/window_surface.h"

namespace cathlab::play {

struct WindowOptions {
    std::string title = "cathlab";
    int width = 1280;
    int height = 720;
    bool fullscreen = false;
    bool plain = false;  ///< without OpenGL, as on a machine that has none
    bool alone = false;  ///< no other GL context is ever current on this thread
};

class Window {
public:
    /// Starts SDL's video.  Throws UserError with the remedy where there is no display.
    explicit Window(const WindowOptions& options);
    ~Window();
    Window(const Window&) = delete;
    Window& operator=(const Window&) = delete;

    int width() const;  ///< in pixels, at least 1
    int height() const;
    bool minimised() const;
    void set_fullscreen(bool yes);
    void resize(int width, int height);

    /// Draws and shows.
    void draw(std::span<const WindowPicture> pictures, std::span<const HudDrawList* const> lists);
    void show();
    /// What was drawn last.
    void read(Image8& out);
    /// How it is drawn: "sdl: 4.5 (Core Profile) Mesa ..., llvmpipe".
    std::string description() const;
    /// "" or why it is not drawn by OpenGL.
    std::string note() const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace cathlab::play
