#include "beam/c_arm.h"

#include <limits>

#include "core/deterministic_math.h"
#include "core/range.h"
#include "core/units.h"

namespace cathlab {
namespace {

Vec2 middle(const CArmSpec& spec) {
    return {0.5 * (spec.columns - 1), 0.5 * (spec.rows - 1)};
}

}  // namespace

void validate(const CArmSpec& spec, const SourcePlace& where) {
    require_range(where, "sid_mm", spec.sid_mm, 500.0, 2000.0);
    require_range(where, "sod_mm", spec.sod_mm, 300.0, spec.sid_mm - 1.0);
    require_range(where, "field_mm", spec.field_mm, 20.0, 600.0);
    require_range(where, "columns", spec.columns, 16, 8192);
    require_range(where, "rows", spec.rows, 16, 8192);
    require_range(where, "rotation_deg_s", spec.rotation_deg_s, 0.1, 360.0);
}

CArmPose c_arm_pose(const CArmSpec& spec, const Vec3& isocentre, double primary_deg, double secondary_deg) {
    const double a = primary_deg * units::deg, b = secondary_deg * units::deg;
    const double sa = det::sin(a), ca = det::cos(a), sb = det::sin(b), cb = det::cos(b);
    CArmPose pose;
    pose.forward = Vec3(sa * cb, -ca * cb, sb);
    pose.right = Vec3(ca, sa, 0.0);
    pose.down = -pose.forward.cross(pose.right);
    pose.source = isocentre - spec.sod_mm * pose.forward;
    pose.detector = isocentre + (spec.sid_mm - spec.sod_mm) * pose.forward;
    return pose;
}

Vec2 project(const CArmSpec& spec, const CArmPose& pose, const Vec3& p_world) {
    const Vec3 ray = p_world - pose.source;
    const double depth = ray.dot(pose.forward);
    if (!(depth > 0.0)) return Vec2::Constant(std::numeric_limits<double>::quiet_NaN());
    const double scale = spec.sid_mm / (depth * spec.pixel_mm());
    return middle(spec) + scale * Vec2(ray.dot(pose.right), ray.dot(pose.down));
}

Vec3 pixel_on_detector(const CArmSpec& spec, const CArmPose& pose, const Vec2& pixel) {
    const Vec2 offset = spec.pixel_mm() * (pixel - middle(spec));
    return pose.detector + offset.x() * pose.right + offset.y() * pose.down;
}

}  // namespace cathlab
