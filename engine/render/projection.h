// World point -> pixel of the detector, and the same as a matrix for GL.
#pragma once

#include <array>

#include "core/types.h"
#include "render/frame_description.h"

namespace cathlab {

/// Pinhole at the source.  A point on the detector at s (mm along right) and t (mm along down) from its centre has the
/// pixel coordinates ((s / width_mm + 1/2) * width, (t / height_mm + 1/2) * height); the pixel (i, j) covers
/// [i, i+1) x [j, j+1).
class Projection {
public:
    /// Throws UserError where the geometry cannot be: source on the detector, extent not positive, axes not
    /// orthonormal.
    Projection(const CArmView& view, int width, int height);

    /// Pixel coordinates; depth() of the point must be positive.
    Vec2 pixel(const Vec3& p_world) const;
    /// mm from the source along the detector's normal.
    double depth(const Vec3& p_world) const { return (p_world - source_).dot(normal_); }
    /// Unit vector from the source through a pixel coordinate.
    Vec3 ray(double x, double y) const;
    /// Point of the detector plane at a pixel coordinate, relative to the source.
    Vec3 to_detector(double x, double y) const {
        return center_ + right_ * ((x / width_ - 0.5) * mm_w_) + down_ * ((y / height_ - 0.5) * mm_h_);
    }

    const Vec3& source() const { return source_; }
    const Vec3& normal() const { return normal_; }  ///< unit, from source to detector
    double source_detector_mm() const { return sid_; }
    double pixel_mm() const { return pixel_mm_; }  ///< at the detector
    int width() const { return width_; }
    int height() const { return height_; }
    /// True where right x down points towards the source: GL then sees triangles as the source does.
    bool mirrored() const { return mirrored_; }
    /// Column-major; source-centred position -> clip space with row 0 at the picture's top, depth 0.
    std::array<float, 16> clip_matrix() const;

private:
    Vec3 source_, normal_, right_, down_, center_;
    double sid_ = 0, mm_w_ = 0, mm_h_ = 0, pixel_mm_ = 0;
    int width_, height_;
    bool mirrored_ = false;
};

/// SID / SOD, of what lies at the isocentre; 1.45 where the view does not say (C-arms: 1.4 to 1.5).
double magnification(const CArmView& view, const Projection& projection);

}  // namespace cathlab
