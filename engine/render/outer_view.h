// The third-person view: vessels like glass, coloured by what the wall feels, and the devices in them.
#pragma once

#include <memory>

#include "imaging/image.h"
#include "render/frame_description.h"

namespace cathlab {

class GlDevice;

class OuterView {
public:
    explicit OuterView(std::shared_ptr<GlDevice> device);
    ~OuterView();
    /// Draws lumen and devices from frame.outer_camera; dark without a camera.  frame.outer_map says what colours the
    /// wall.
    void draw(const FrameDescription& frame, int width, int height, Image8& out);

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

/// Colour of a share in [0, 1], linear RGB: from the wall's own through yellow to a pale violet, as in the inner view;
/// told apart by lightness too.
Vec3 map_color(double share);

}  // namespace cathlab
