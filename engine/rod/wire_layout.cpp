#include "rod/wire_layout.h"

#include <cmath>

#include "core/deterministic_math.h"

namespace cathlab {
namespace {

// Walks along a polyline: each call goes to the first point ahead at a given distance from the point where it stands.
class Walker {
public:
    Walker(std::vector<Vec3> points, const Vec3& from) : points_(std::move(points)), at_(from) {}

    Vec3 next(double distance) {
        for (; segment_ + 1 < points_.size(); ++segment_) {
            const Vec3& a = points_[segment_];
            const Vec3& b = points_[segment_ + 1];
            if ((b - at_).norm() < distance) continue;
            // |a + s (b - a) - at|^2 = distance^2, the larger root: where the segment leaves the sphere.
            const Vec3 d = b - a, e = a - at_;
            const double dd = d.squaredNorm(), de = d.dot(e);
            const double under = de * de - dd * (e.squaredNorm() - distance * distance);
            at_ = a + d * ((-de + std::sqrt(under > 0.0 ? under : 0.0)) / dd);
            return at_;
        }
        const Vec3 direction = (points_[points_.size() - 1] - points_[points_.size() - 2]).normalized();
        // Straight on from the end: the point at `distance` on the ray that starts at the last point.
        const Vec3 e = points_.back() - at_;
        const double de = direction.dot(e);
        const double under = de * de - (e.squaredNorm() - distance * distance);
        at_ = points_.back() + direction * (-de + std::sqrt(under > 0.0 ? under : 0.0));
        return at_;
    }

private:
    std::vector<Vec3> points_;
    std::size_t segment_ = 0;
    Vec3 at_;
};

}  // namespace

std::vector<Pose> lay_along(std::span<const WireLink> links, std::size_t free, double insertion, const Pose& mouth,
                            std::span<const Vec3> path) {
    std::vector<Pose> poses(free);
    const Vec3 inward = mouth.orientation * Vec3::UnitZ();
    const auto on_axis = [&](double beyond) { return Vec3(mouth.position + inward * beyond); };
    // The rear end of the last free link stands at the mouth or behind it.
    Vec3 rear = on_axis(insertion - links[free - 1].end());
    std::vector<Vec3> points{rear, on_axis(0.0)};
    for (const Vec3& p : path)
        if ((p - points.back()).norm() > 1e-6) points.push_back(p);
    if ((points[1] - points[0]).norm() < 1e-9) points.erase(points.begin());
    if (points.size() < 2) points.push_back(points.front() + inward);
    Walker walker(points, rear);
    Quat frame = mouth.orientation;
    Vec3 axis = inward;
    for (std::size_t i = free; i-- > 0;) {
        const Vec3 front = walker.next(links[i].length);
        const Vec3 direction = (front - rear).normalized();
        frame = det::rotation_between(axis, direction) * frame;
        frame.normalize();
        axis = direction;
        poses[i] = {0.5 * (front + rear), frame};
        rear = front;
    }
    return poses;
}

}  // namespace cathlab
