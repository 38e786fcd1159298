// Devices by themselves, without a step around them, as samples that the wall can meet.
#pragma once

#include <vector>

#include "catheter/shape.h"
#include "contact/rows.h"
#include "core/deterministic_math.h"
#include "rod/rod.h"

namespace cathlab {

/// The wire's samples through one substep: remembers where its links were, so that each sample knows its path and how
/// far its link has turned.
class WireSamples {
public:
    /// friction: against the wall, >= 0.  spacing_mm: largest distance between samples, > 0.
    WireSamples(Index device, double friction, double spacing_mm)
        : device_(device), friction_(friction), spacing_mm_(spacing_mm) {}

    /// Before Rod::command of the substep.
    void begin(const Rod& rod);

    /// Appends the samples where they are now, tip first; same number and order from command to the end of the substep.
    /// A link that entered the chain in this substep counts as having been at rest.
    void append(const Rod& rod, std::vector<DeviceSample>& samples);

private:
    Index device_;
    double friction_;
    double spacing_mm_;
    std::vector<Pose> before_;
    std::vector<RodSample> found_;
};

inline void WireSamples::begin(const Rod& rod) {
    before_.resize(rod.link_count());
    for (std::size_t i = 0; i < before_.size(); ++i) before_[i] = rod.link_pose(i);
}

inline void WireSamples::append(const Rod& rod, std::vector<DeviceSample>& samples) {
    rod.samples(spacing_mm_, found_);
    double link_start = 0.0;  // material arc length of the link's front end
    std::size_t link = 0;
    for (const RodSample& f : found_) {
        for (; link < static_cast<std::size_t>(f.link); ++link) link_start += rod.link_length(link);
        const Pose now = rod.link_pose(link);
        DeviceSample s;
        s.position = f.position;
        s.radius = f.radius;
        s.device = device_;
        s.arc_mm = link_start + 0.5 * rod.link_length(link) - f.arm.dot(now.orientation * Vec3::UnitZ());
        s.link = f.link;
        s.arm = f.arm;
        s.friction = friction_;
        s.previous = f.position;
        if (link < before_.size()) {
            s.previous = before_[link].to_world(now.orientation.conjugate() * f.arm);
            s.rotation = det::vector_from_rotation(now.orientation * before_[link].orientation.conjugate());
        }
        samples.push_back(s);
    }
}

/// Appends the samples of a kinematic catheter, base first.  before, now: its shapes at the beginning and the end of
/// the substep (kinematic devices stand at their end throughout the iteration); matched from the tip (shape.h). radius:
/// mm.
inline void append_catheter_samples(const CatheterShape& before, const CatheterShape& now, double radius, Index device,
                                    double friction, std::vector<DeviceSample>& samples) {
    const std::size_t count = now.points.size();
    for (std::size_t i = 0; i < count; ++i) {
        const std::size_t from_tip = count - 1 - i;
        DeviceSample s;
        s.position = now.points[i];
        s.radius = radius;
        s.device = device;
        s.arc_mm = now.arc[count - 1] - now.arc[i];
        s.friction = friction;
        s.kinematic = true;
        s.previous =
            from_tip < before.points.size() ? before.points[before.points.size() - 1 - from_tip] : now.points[i];
        samples.push_back(s);
    }
}

}  // namespace cathlab
