// The rigs on which a wall is calibrated: a tube, stations of a vessel tree, a ring, a strip, a block.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "core/parallel.h"
#include "scene/scene_spec.h"
#include "softbody/tube.h"

namespace cathlab {

/// What the stress of a reference is taken for.  The wall keeps its volume, so that its section under load is the
/// section at rest / (1 + epsilon).
enum class RigStress {
    hoop,     ///< the true stress in the wall, on its section under load: round a lumen a pressure p = sigma t / r
    nominal,  ///< the same force on the section at rest: round a lumen F / A0 = sigma t0 / r0
    paper     ///< sigma = F / A of [li2025] as it stands: a radial traction, r0 / t0 times as much
};

enum class RigKind {
    tube,      ///< held at both ends, pushed outwards
    stations,  ///< places of a vessel tree, each pushed outwards from its centre-line
    ring,      ///< a slice of a tube, its ends free, pushed outwards
    strip,     ///< flat, held at one end, pulled at the other
    block      ///< flat, between smooth plates that keep it flat and its deformation even; pulled or pressed
};

/// "tube", "stations", ... as a scene spells it.
std::string_view rig_name(RigKind kind);

struct StationWall;  // calibrate/stations.h

/// Const while it is used; may be shared by worlds.  There is no device, no heart, and nothing around the wall.
struct WallRig {
    RigKind kind = RigKind::tube;
    RigStress stress = RigStress::hoop;
    /// Of the tube; of the ring, whose width is the length.
    TubeShape shape{.radius_mm = 12.0, .length_mm = 80.0, .edge_mm = 1.0, .closed = false};
    double length_mm = 60.0, width_mm = 12.0;     ///< of strip and block; length along the pull
    double thickness_mm = 1.0;                    ///< of all but stations
    std::shared_ptr<const StationWall> stations;  ///< of kind stations
    std::uint64_t seed = 1;

    bool round() const { return kind != RigKind::strip && kind != RigKind::block; }
};

/// Where the anatomy of a rig with stations comes from.
struct RigOptions {
    std::string cache_folder;  ///< for built anatomies; "" = build anew
    int threads = 1;
    std::function<void(double fraction, std::string_view what)> progress;
};

/// The rig that a scene describes ([rig], scene_spec.h).
///   tube, ring, strip, block   want one straight vessel of one radius in a parametric anatomy.  The wall's thickness
///   is
///       that of its region.  A ring has its radius and the rig's width (10 mm); a strip is as long as the tube and 12
///       mm wide, a block 20 mm by 20 mm, unless the rig says otherwise; both are cut round the vessel
///   stations                   any anatomy, parametric or imported
/// Throws UserError for an anatomy, a size or a station that cannot be.
WallRig wall_rig(const SceneSpec& scene, const RigOptions& options = {});

/// Throws UserError where the numbers of a rig make none: radius, thickness or lengths that are not above 0, a tube
/// whose held ends are felt in its middle, a strip that is not three times as long as wide, the paper's stress of what
/// is not round.
void check(const WallRig& rig);

}  // namespace cathlab
