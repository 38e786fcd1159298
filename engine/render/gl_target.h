// Where OpenGL draws when there is no window.  The rest of the room sees this interface and a table of functions; which
// library made the context stays in its adapter.  libGL and libOSMesa are never linked: they are opened by name.
#pragma once

#include <memory>
#include <string>

namespace cathlab {

class GlTarget {
public:
    virtual ~GlTarget() = default;
    /// Makes the context current on the calling thread.
    virtual void make_current() = 0;
    /// Address of a GL function, null where the context has none of that name.
    virtual void* proc(const char* name) = 0;
    virtual std::string name() const = 0;
};

/// name: "osmesa" (default everywhere) or "egl" (surfaceless).  Throws UserError with the reason where the library or a
/// GL 3.3 core context is missing, or the name is unknown.
std::unique_ptr<GlTarget> make_gl_target(const std::string& name = "osmesa");

std::unique_ptr<GlTarget> make_osmesa_target();
std::unique_ptr<GlTarget> make_egl_target();

}  // namespace cathlab
