#include "play/view_projection.h"

namespace cathlab::play {

std::optional<Vec2> place_on_picture(const CArmView& view, const Vec3& point) {
    const Vec3 axis = view.detector_center - view.source;
    const Vec3 ray = point - view.source;
    const double depth = ray.dot(axis) / axis.squaredNorm();  // share of the way to the detector
    if (!(depth > 1e-6)) return std::nullopt;
    const Vec3 on_detector = view.source + ray / depth - view.detector_center;
    return Vec2(0.5 + on_detector.dot(view.right) / view.width_mm, 0.5 + on_detector.dot(view.down) / view.height_mm);
}

}  // namespace cathlab::play
