#include <GL/osmesa.h>

#include <array>
#include <vector>

#include "core/errors.h"
#include "render/gl_target.h"
#include "render/shared_library.h"

namespace cathlab {

namespace {

class OsMesaTarget final : public GlTarget {
public:
    OsMesaTarget()
        : library_("libOSMesa.so.8", "libosmesa6"),
          make_current_(library_.function<decltype(OSMesaMakeCurrent)>("OSMesaMakeCurrent")),
          destroy_(library_.function<decltype(OSMesaDestroyContext)>("OSMesaDestroyContext")),
          proc_(library_.function<decltype(OSMesaGetProcAddress)>("OSMesaGetProcAddress")) {
        const auto create = library_.function<decltype(OSMesaCreateContextAttribs)>("OSMesaCreateContextAttribs");
        const std::array<int, 13> wanted = {OSMESA_FORMAT,
                                            OSMESA_RGBA,
                                            OSMESA_DEPTH_BITS,
                                            0,
                                            OSMESA_STENCIL_BITS,
                                            0,
                                            OSMESA_PROFILE,
                                            OSMESA_CORE_PROFILE,
                                            OSMESA_CONTEXT_MAJOR_VERSION,
                                            3,
                                            OSMESA_CONTEXT_MINOR_VERSION,
                                            3,
                                            0};
        context_ = create(wanted.data(), nullptr);
        if (context_ == nullptr) throw UserError("cannot draw off-screen: OSMesa gives no OpenGL 3.3 core context");
        buffer_.resize(std::size_t{16} * 16 * 4);
        make_current();
    }
    ~OsMesaTarget() override { destroy_(context_); }

    void make_current() override {
        // Everything is drawn into framebuffer objects; the context's own buffer only has to exist.
        if (make_current_(context_, buffer_.data(), GL_UNSIGNED_BYTE, 16, 16) == 0) {
            throw UserError("cannot draw off-screen: OSMesa refused its context");
        }
    }
    void* proc(const char* name) override { return reinterpret_cast<void*>(proc_(name)); }
    std::string name() const override { return "osmesa"; }

private:
    SharedLibrary library_;
    decltype(OSMesaMakeCurrent)* make_current_;
    decltype(OSMesaDestroyContext)* destroy_;
    decltype(OSMesaGetProcAddress)* proc_;
    OSMesaContext context_ = nullptr;
    std::vector<unsigned char> buffer_;
};

}  // namespace

std::unique_ptr<GlTarget> make_osmesa_target() {
    return std::make_unique<OsMesaTarget>();
}

}  // namespace cathlab
