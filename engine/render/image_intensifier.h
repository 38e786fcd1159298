// What an image intensifier does to a picture and a flat panel does not: veiling glare, pincushion distortion, a round
// field.
#pragma once

#include "core/parallel.h"
#include "core/types.h"
#include "imaging/image.h"
#include "render/frame_description.h"

namespace cathlab {

/// Where a curved entrance screen shows what the pinhole puts at a place: away from the middle by 1 + k (r / R)^2, R
/// half of the picture's shorter side.  Places as in Projection: pixel (i, j) covers [i, i+1) x [j, j+1).
class Pincushion {
public:
    Pincushion(double k, int width, int height);
    Vec2 shown(const Vec2& pinhole) const;
    /// The inverse, to 1e-9 of R.
    Vec2 pinhole(const Vec2& shown) const;
    bool none() const { return k_ == 0.0; }

private:
    double k_, radius_;
    Vec2 middle_;
};

/// Veiling glare, then distortion (bilinear), then black outside the round field; a flat panel's picture stays as it
/// is.
void distort(ImageF& image, const FrameDetector& detector, double pixel_mm, const Workers& workers);

}  // namespace cathlab
