// The X-ray picture: path lengths -> polychromatic Beer-Lambert -> noise -> blur -> recursion -> grey.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string_view>
#include <vector>

#include "core/parallel.h"
#include "imaging/image.h"
#include "render/frame_description.h"

namespace cathlab {

/// State between frames: the cached context (torso) of the present view, and the temporal filter's memory, which
/// restarts when the C-arm moves.  The picture is a function of the descriptions drawn since then.
class Fluoroscope {
public:
    explicit Fluoroscope(Workers workers);
    ~Fluoroscope();

    /// Grey, one byte a pixel, rows from the top, devices dark on light.  Throws UserError on an impossible geometry or
    /// an unknown material.
    const std::vector<std::uint8_t>& draw(const FrameDescription& frame, int width, int height);

    /// Intensity of the last frame before noise and blur, relative to the beam without a patient (scatter included).
    const ImageF& intensity() const;
    /// What the detector read in the last frame, in detected photons a pixel: with noise and blur, before recursion.
    const ImageF& detected() const;
    /// The last picture, as draw() gave it.
    const std::vector<std::uint8_t>& grey() const;
    /// The picture that was kept as the reference, as large as the last one; empty where none was.
    const std::vector<std::uint8_t>& reference() const;
    /// Whether there is a roadmap of the present view.
    bool has_roadmap() const;
    /// Detected photons a pixel that the last frame's kerma means.
    double wanted_photons() const;
    /// Rays of the last frame whose entries and exits do not match (open surfaces); must be 0.
    std::size_t bad_pixels() const;
    /// Called in draw() as each part of the chain begins, "" as the last ends, for measuring.
    void set_probe(std::function<void(std::string_view part)> begin);
    /// Brings the next frame to a fresh start (a new run).
    void reset();

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace cathlab
