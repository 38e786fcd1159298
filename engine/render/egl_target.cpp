#include <EGL/egl.h>
#include <EGL/eglext.h>

#include <array>

#include "core/errors.h"
#include "render/gl_target.h"
#include "render/shared_library.h"

namespace cathlab {

namespace {

class EglTarget final : public GlTarget {
public:
    EglTarget()
        : library_("libEGL.so.1", "libegl1"),
          make_current_(library_.function<decltype(eglMakeCurrent)>("eglMakeCurrent")),
          destroy_(library_.function<decltype(eglDestroyContext)>("eglDestroyContext")),
          proc_(library_.function<decltype(eglGetProcAddress)>("eglGetProcAddress")) {
        const auto get_display = library_.function<decltype(eglGetPlatformDisplay)>("eglGetPlatformDisplay");
        const auto initialize = library_.function<decltype(eglInitialize)>("eglInitialize");
        const auto bind_api = library_.function<decltype(eglBindAPI)>("eglBindAPI");
        const auto create = library_.function<decltype(eglCreateContext)>("eglCreateContext");
        display_ = get_display(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
        if (display_ == EGL_NO_DISPLAY || initialize(display_, nullptr, nullptr) == EGL_FALSE ||
            bind_api(EGL_OPENGL_API) == EGL_FALSE) {
            throw UserError("cannot draw off-screen: EGL has no surfaceless display (Debian package libegl-mesa0)");
        }
        const std::array<EGLint, 7> wanted = {
            EGL_CONTEXT_MAJOR_VERSION,           3,       EGL_CONTEXT_MINOR_VERSION, 3, EGL_CONTEXT_OPENGL_PROFILE_MASK,
            EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT, EGL_NONE};
        context_ = create(display_, nullptr, EGL_NO_CONTEXT, wanted.data());
        if (context_ == EGL_NO_CONTEXT) throw UserError("cannot draw off-screen: EGL gives no OpenGL 3.3 core context");
        make_current();
    }
    ~EglTarget() override {
        make_current_(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
        destroy_(display_, context_);
    }

    void make_current() override {
        if (make_current_(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_) == EGL_FALSE) {
            throw UserError("cannot draw off-screen: EGL refused its context");
        }
    }
    void* proc(const char* name) override { return reinterpret_cast<void*>(proc_(name)); }
    std::string name() const override { return "egl"; }

private:
    SharedLibrary library_;
    decltype(eglMakeCurrent)* make_current_;
    decltype(eglDestroyContext)* destroy_;
    decltype(eglGetProcAddress)* proc_;
    EGLDisplay display_ = EGL_NO_DISPLAY;
    EGLContext context_ = EGL_NO_CONTEXT;
};

}  // namespace

std::unique_ptr<GlTarget> make_egl_target() {
    return std::make_unique<EglTarget>();
}

}  // namespace cathlab
