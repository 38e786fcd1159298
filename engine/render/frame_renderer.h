// One description of a frame -> one picture: fluoroscopy left, inner view right, HUD over both.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "core/parallel.h"
#include "imaging/image.h"
#include "render/frame_description.h"
#include "render/gl_target.h"

namespace cathlab {

/// A part of the picture, pixels from the top left.
struct FrameRect {
    int x = 0, y = 0, width = 0, height = 0;
};

/// Where the parts of a picture stand.  The fluoroscopy takes a square at the left, inner view, outer view and
/// reference share the rest, one above the other; one view alone: the largest centred square (fluoroscopy) or
/// everything.
struct FrameLayout {
    FrameRect fluoroscopy, inner_view, outer_view, reference;
};
FrameLayout layout_of(const FrameDescription& frame);

/// Draws off-screen.  Use one renderer from one thread at a time; parallel rendering means processes.
class FrameRenderer {
public:
    /// Throws UserError where no off-screen GL can be had.
    explicit FrameRenderer(std::unique_ptr<GlTarget> target, const Workers& workers = Workers());
    ~FrameRenderer();

    /// Makes out a picture of frame.width x frame.height (at least 64 x 64, at most 8192; else UserError).
    void render(const FrameDescription& frame, Image8& out);

    /// Rays of the last frame that found an open surface: must be 0.
    std::size_t bad_pixels() const;
    /// Linear intensity of the last frame's fluoroscopy, before noise.
    const ImageF& intensity() const;
    /// What the detector read in the last frame, detected photons a pixel, before recursion.
    const ImageF& detected() const;
    /// The last fluoroscopy as it is shown, without the panels: grey, one byte a pixel, rows from the top.
    const std::vector<std::uint8_t>& fluoroscopy() const;
    /// The picture that was kept as the reference, likewise; empty where none was.
    const std::vector<std::uint8_t>& reference() const;
    /// Whether there is a roadmap of the present view.
    bool has_roadmap() const;
    /// Detected photons a pixel that the exposure of the last frame asks for in the measuring field.
    double wanted_photons() const;
    /// Forgets the last frames (temporal filter, held image): the start of another run.
    void reset();
    std::string description() const;
    /// Called in render() as each part begins ("fluoroscopy", "inner view", "outer view",
    /// "overlay"), for measuring.
    void set_probe(std::function<void(std::string_view part)> begin);
    /// The same for the parts of the fluoroscopy's chain.
    void set_fluoroscopy_probe(std::function<void(std::string_view part)> begin);

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace cathlab
