// Paints a HUD's triangles over a finished picture.
#pragma once

#include <memory>

#include "imaging/draw_list.h"
#include "imaging/image.h"

namespace cathlab {

class GlDevice;

class Overlay {
public:
    explicit Overlay(std::shared_ptr<GlDevice> device);
    ~Overlay();
    /// The list's width and height must be the picture's (CATHLAB_CHECK); an empty list changes nothing.
    void draw(const HudDrawList& list, Image8& picture);

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace cathlab
