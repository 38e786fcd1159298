#include "render/shared_library.h"

#include <dlfcn.h>

#include "core/errors.h"

namespace cathlab {

SharedLibrary::SharedLibrary(const std::string& file, const std::string& package)
    : handle_(dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL)), file_(file) {
    if (handle_ == nullptr) {
        const char* reason = dlerror();
        throw UserError("cannot draw off-screen: " + std::string(reason != nullptr ? reason : file) +
                        " (Debian package " + package + ")");
    }
}

// Mesa's drivers keep threads and exit handlers: a library once opened stays in the process.
SharedLibrary::~SharedLibrary() = default;

void* SharedLibrary::address(const char* name) const {
    void* found = dlsym(handle_, name);
    if (found == nullptr) throw UserError("cannot draw off-screen: " + file_ + " lacks " + name);
    return found;
}

}  // namespace cathlab
