#include "render/projection.h"

#include <cmath>

#include "core/errors.h"

namespace cathlab {

Projection::Projection(const CArmView& view, int width, int height)
    : source_(view.source),
      right_(view.right),
      down_(view.down),
      center_(view.detector_center - view.source),
      mm_w_(view.width_mm),
      mm_h_(view.height_mm),
      width_(width),
      height_(height) {
    const double unit_error = std::fabs(right_.norm() - 1) + std::fabs(down_.norm() - 1) + std::fabs(right_.dot(down_));
    if (!(unit_error < 1e-6)) throw UserError("C-arm: the detector's axes must be orthogonal unit vectors");
    if (!(mm_w_ > 0 && mm_h_ > 0)) throw UserError("C-arm: the field of view must be larger than zero");
    if (width < 2 || height < 2) throw UserError("C-arm: the picture needs at least 2 x 2 pixels");
    normal_ = right_.cross(down_);
    sid_ = center_.dot(normal_);
    mirrored_ = sid_ < 0;
    if (mirrored_) {
        normal_ = -normal_;
        sid_ = -sid_;
    }
    if (!(sid_ > 1.0)) throw UserError("C-arm: the X-ray source must stand clear of the detector's plane");
    pixel_mm_ = 0.5 * (mm_w_ / width + mm_h_ / height);
}

Vec2 Projection::pixel(const Vec3& p_world) const {
    const Vec3 from_source = p_world - source_;
    const Vec3 hit = from_source * (sid_ / from_source.dot(normal_)) - center_;
    return {(hit.dot(right_) / mm_w_ + 0.5) * width_, (hit.dot(down_) / mm_h_ + 0.5) * height_};
}

Vec3 Projection::ray(double x, double y) const {
    return to_detector(x, y).normalized();
}

std::array<float, 16> Projection::clip_matrix() const {
    // clip.w = depth; clip.x / clip.w = 2 (s - s_c) / width_mm, with s = p.right * sid / depth and s_c of the centre.
    const Vec3 row_x = right_ * (2 * sid_ / mm_w_) - normal_ * (2 * center_.dot(right_) / mm_w_);
    const Vec3 row_y = down_ * (2 * sid_ / mm_h_) - normal_ * (2 * center_.dot(down_) / mm_h_);
    std::array<float, 16> m{};
    for (int c = 0; c < 3; ++c) {
        const std::size_t column = std::size_t{4} * static_cast<std::size_t>(c);
        m[column] = static_cast<float>(row_x[c]);
        m[column + 1] = static_cast<float>(row_y[c]);
        m[column + 3] = static_cast<float>(normal_[c]);
    }
    return m;
}

double magnification(const CArmView& view, const Projection& projection) {
    constexpr double usual = 1.45;
    return view.source_isocentre_mm > 0 ? projection.source_detector_mm() / view.source_isocentre_mm : usual;
}

}  // namespace cathlab
