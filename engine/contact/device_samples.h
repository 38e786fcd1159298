// Devices as samples that the wall can meet.
#pragma once

#include <vector>

#include "catheter/shape.h"
#include "contact/rows.h"
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

/// Appends the samples of a kinematic catheter, base first.  before, now: its shapes at the beginning and the end of
/// the substep (kinematic devices stand at their end throughout the iteration); matched from the tip (shape.h). radius:
/// mm.
void append_catheter_samples(const CatheterShape& before, const CatheterShape& now, double radius, Index device,
                             double friction, std::vector<DeviceSample>& samples);

}  // namespace cathlab
