// What a camera at the device's tip would see: the lumen's wall under a headlight.
#pragma once

#include <memory>

#include "imaging/image.h"
#include "render/frame_description.h"

namespace cathlab {

class GlDevice;

class InnerView {
public:
    explicit InnerView(std::shared_ptr<GlDevice> device);
    ~InnerView();
    /// Draws lumen and devices from frame.inner_camera; black without a camera.  The force on the wall shows as colour
    /// from tissue to yellow (half the limit) to violet-white (the limit), a ramp that colour-blind eyes can follow.
    void draw(const FrameDescription& frame, int width, int height, Image8& out);

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace cathlab
