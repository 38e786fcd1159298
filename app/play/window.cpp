#include "play/window.h"

#include <SDL.h>

#include <algorithm>

#include "core/errors.h"

namespace cathlab::play {
namespace {

// The window's own GL context.
class SdlTarget final : public GlTarget {
public:
    SdlTarget(SDL_Window* window, SDL_GLContext context, bool alone)
        : window_(window), context_(context), alone_(alone) {}
    ~SdlTarget() override { SDL_GL_DeleteContext(context_); }
    SdlTarget(const SdlTarget&) = delete;
    SdlTarget& operator=(const SdlTarget&) = delete;
    void make_current() override {
        if (alone_ && SDL_GL_GetCurrentContext() == context_) return;
        // SDL leaves out what it believes to be so already; but an off-screen context may have come between on this
        // thread, of which it does not know.
        SDL_GL_MakeCurrent(window_, nullptr);
        if (SDL_GL_MakeCurrent(window_, context_) != 0)
            throw UserError(std::string("the window's OpenGL was lost: ") + SDL_GetError());
    }
    void* proc(const char* name) override { return SDL_GL_GetProcAddress(name); }
    std::string name() const override { return "sdl"; }

private:
    SDL_Window* window_;
    SDL_GLContext context_;
    bool alone_;
};

std::string no_display() {
    return std::string("no window can be opened: ") + SDL_GetError() +
           "; a display is wanted (DISPLAY or WAYLAND_DISPLAY), or without one: ./run demo films a run, and "
           "xvfb-run makes a display that nobody sees";
}

}  // namespace

struct Window::Impl {
    SDL_Window* window = nullptr;
    std::unique_ptr<WindowSurface> surface;
    bool by_gl = false;
    std::string note;
    Image8 copy;  // of what is drawn off-screen

    void open(const WindowOptions& options, Uint32 flags) {
        window = SDL_CreateWindow(options.title.c_str(), SDL_WINDOWPOS_CENTERED, SDL_WINDOWPOS_CENTERED, options.width,
                                  options.height, flags | SDL_WINDOW_RESIZABLE);
    }
    bool open_gl(const WindowOptions& options) {
        SDL_GL_SetAttribute(SDL_GL_CONTEXT_PROFILE_MASK, SDL_GL_CONTEXT_PROFILE_CORE);
        SDL_GL_SetAttribute(SDL_GL_CONTEXT_MAJOR_VERSION, 3);
        SDL_GL_SetAttribute(SDL_GL_CONTEXT_MINOR_VERSION, 3);
        SDL_GL_SetAttribute(SDL_GL_DOUBLEBUFFER, 1);
        open(options, SDL_WINDOW_OPENGL | SDL_WINDOW_ALLOW_HIGHDPI);
        if (window == nullptr) {
            note = SDL_GetError();
            return false;
        }
        try {
            SDL_GLContext context = SDL_GL_CreateContext(window);
            if (context == nullptr) throw UserError(SDL_GetError());
            surface =
                std::make_unique<WindowSurface>(std::make_unique<SdlTarget>(window, context, options.alone), false);
            SDL_GL_SetSwapInterval(1);
            return true;
        } catch (const UserError& error) {
            note = error.what();
        }
        surface.reset();
        SDL_DestroyWindow(window);
        window = nullptr;
        return false;
    }
};

Window::Window(const WindowOptions& options) : impl_(std::make_unique<Impl>()) {
    Impl& m = *impl_;
    if (SDL_InitSubSystem(SDL_INIT_VIDEO) != 0) throw UserError(no_display());
    try {
        m.by_gl = !options.plain && m.open_gl(options);
        if (!m.by_gl) {
            m.open(options, 0);
            if (m.window == nullptr) throw UserError(no_display());
            m.surface = std::make_unique<WindowSurface>(make_gl_target(), true);
            if (!m.note.empty())
                m.note = "the window has no OpenGL 3.3 (" + m.note + "); it is drawn off-screen, slower";
        }
    } catch (...) {
        if (m.window != nullptr) SDL_DestroyWindow(m.window);
        SDL_QuitSubSystem(SDL_INIT_VIDEO);
        throw;
    }
    SDL_SetWindowMinimumSize(m.window, 64, 64);
    set_fullscreen(options.fullscreen);
}

Window::~Window() {
    impl_->surface.reset();
    SDL_DestroyWindow(impl_->window);
    SDL_QuitSubSystem(SDL_INIT_VIDEO);
}

int Window::width() const {
    int w = 0, h = 0;
    impl_->by_gl ? SDL_GL_GetDrawableSize(impl_->window, &w, &h) : SDL_GetWindowSize(impl_->window, &w, &h);
    return std::max(1, w);
}

int Window::height() const {
    int w = 0, h = 0;
    impl_->by_gl ? SDL_GL_GetDrawableSize(impl_->window, &w, &h) : SDL_GetWindowSize(impl_->window, &w, &h);
    return std::max(1, h);
}

bool Window::minimised() const {
    return (SDL_GetWindowFlags(impl_->window) & SDL_WINDOW_MINIMIZED) != 0;
}

void Window::set_fullscreen(bool yes) {
    SDL_SetWindowFullscreen(impl_->window, yes ? SDL_WINDOW_FULLSCREEN_DESKTOP : 0);
}

void Window::resize(int width, int height) {
    SDL_SetWindowSize(impl_->window, width, height);
}

void Window::draw(std::span<const WindowPicture> pictures, std::span<const HudDrawList* const> lists) {
    impl_->surface->draw(width(), height(), pictures, lists);
}

void Window::show() {
    Impl& m = *impl_;
    if (m.by_gl) {
        SDL_GL_SwapWindow(m.window);
        return;
    }
    m.surface->read(m.copy);
    SDL_Surface* screen = SDL_GetWindowSurface(m.window);
    if (screen == nullptr) return;  // between two sizes; the next picture comes soon
    SDL_Surface* drawn = SDL_CreateRGBSurfaceWithFormatFrom(m.copy.rgb.data(), m.copy.width, m.copy.height, 24,
                                                            3 * m.copy.width, SDL_PIXELFORMAT_RGB24);
    if (drawn == nullptr) return;
    SDL_BlitSurface(drawn, nullptr, screen, nullptr);
    SDL_FreeSurface(drawn);
    SDL_UpdateWindowSurface(m.window);
}

void Window::read(Image8& out) {
    impl_->surface->read(out);
}

std::string Window::description() const {
    return impl_->surface->description();
}

std::string Window::note() const {
    return impl_->note;
}

}  // namespace cathlab::play
