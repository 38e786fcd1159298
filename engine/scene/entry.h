// Where a device comes in, and the way that it is laid along.
#pragma once

#include <vector>

#include "anatomy/model.h"
#include "scene/scene_spec.h"

namespace cathlab {

struct WayIn {
    EntrySite entry;           ///< its pose: where the sheath's mouth stands, z into the vessel
    std::vector<Vec3> points;  ///< from the mouth inward: to the heart, or to the end that is farthest
    std::vector<Vec3> guide;   ///< a guiding catheter's way, from the mouth back to where it enters; empty without one
    bool guided() const { return !guide.empty(); }
};

/// Of device.entry: an entry site of the anatomy or, where a guide may be (the wire), a landmark: then a guiding
/// catheter is engaged there, its mouth some millimetres inside the vessel.  Throws UserError where there is no such
/// name, or nothing leads on from it.
WayIn find_way_in(const AnatomyModel& anatomy, const SceneDevice& device, bool may_guide);

/// Throws UserError where a device of that radius does not fit in.
void check_width(const WayIn& way, double radius_mm, const SceneDevice& device);

/// A device begins within the vessels, and no further in than it is long: throws UserError otherwise.
void check_insertion(const WayIn& way, double length_mm, const SceneDevice& device);

}  // namespace cathlab
