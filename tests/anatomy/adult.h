// The default adult, built once for all tests of this program.
#pragma once

#include "anatomy/build.h"
#include "core/parallel.h"

namespace cathlab::test {

/// A straight tube along z with free ends at 0 and length.
inline AnatomySpec straight_tube(double radius, double length) {
    AnatomySpec spec;
    spec.name = "tube";
    spec.torso = false;
    RegionSpec region;
    region.name = "tube";
    spec.regions.push_back(region);
    VesselSpec vessel;
    vessel.name = "tube";
    vessel.region = "tube";
    vessel.fixed_end = true;
    vessel.points = {{0.0, 0.0, 0.0, radius}, {0.0, 0.0, length, radius}};
    spec.vessels.push_back(vessel);
    EntrySpec entry;
    entry.name = "end";
    entry.vessel = "tube";
    spec.entries.push_back(entry);
    spec.meshing.voxel_mm = radius / 6.0;
    spec.meshing.face_count = 3000;
    return spec;
}

/// Two tubes that leave the end of a third at about 40 degrees.
inline AnatomySpec fork() {
    AnatomySpec spec = straight_tube(4.0, 30.0);
    spec.vessels[0].fixed_end = false;
    for (const double side : {-1.0, 1.0}) {
        VesselSpec leg;
        leg.name = side < 0.0 ? "right" : "left";
        leg.parent = "tube";
        leg.region = "tube";
        leg.points = {{0.0, 0.0, 30.0, 3.0}, {side * 7.0, 0.0, 45.0, 3.0}, {side * 14.0, 0.0, 65.0, 3.0}};
        spec.vessels.push_back(leg);
    }
    spec.entries[0].vessel = "left";
    spec.meshing.face_count = 4000;
    return spec;
}

}  // namespace cathlab::test
