// For this room's .cpp files only.
#pragma once

#include "render/gl_device.h"

namespace cathlab {

class PathSurface {
public:
    explicit PathSurface(GlDevicePtr device) : mesh(std::move(device), {3}) {}
    GlMesh mesh;
};

}  // namespace cathlab
