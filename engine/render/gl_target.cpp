#include "render/gl_target.h"

#include "core/errors.h"

namespace cathlab {

std::unique_ptr<GlTarget> make_gl_target(const std::string& name) {
    if (name == "osmesa") return make_osmesa_target();
    if (name == "egl") return make_egl_target();
    throw UserError("no off-screen renderer '" + name + "'; known are osmesa, egl" +
                    did_you_mean(name, {"osmesa", "egl"}));
}

}  // namespace cathlab
