// A straight tube as a closed triangle mesh: the wall whose answers are known by hand, for tests, rigs and benchmarks.
#pragma once

#include "core/mesh.h"
#include "softbody/wall_sample.h"

namespace cathlab {

struct TubeShape {
    double radius_mm = 12.0;
    double length_mm = 100.0;
    double edge_mm = 0.5;       ///< wanted edge length; at least 12 edges go round
    bool closed = true;         ///< flat ends (a lumen surface is closed); false leaves both ends open
    Vec3 start = Vec3::Zero();  ///< centre of the first end
    Vec3 axis = Vec3::UnitZ();  ///< unit
};

/// The tube's surface, triangles outward.
TriMesh tube_mesh(const TubeShape& shape);

/// An open tube, 42 radii long (an aorta's 12 mm by 500), on whose wall about `particles` of this spacing find room.
/// particles > 0; spacing_mm > 0.  Its edges are half the spacing.
TubeShape tube_for(std::size_t particles, double spacing_mm);

/// The tube sampled with one region of the given spacing and thickness.
WallSample tube_sample(const TubeShape& shape, double spacing_mm, double thickness_mm, std::uint64_t seed);

}  // namespace cathlab
