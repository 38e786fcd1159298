// Stations of a vessel tree: the pieces of its wall near named places of the centre-line, for the stress-strain rig.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "anatomy/model.h"
#include "calibrate/specimen.h"
#include "scene/scene_spec.h"

namespace cathlab {

/// A place of the centre-line with the stretch of vessel round it, in units of the lumen's radius there:
inline constexpr double station_read_radii = 0.5;    ///< strain is read so far to either side
inline constexpr double station_loaded_radii = 2.5;  ///< the wall is pushed so far
inline constexpr double station_kept_radii = 3.0;    ///< there the piece ends, and is held

struct Station {
    std::string name, region;
    Vec3 place = Vec3::Zero();
    Vec3 axis = Vec3::UnitZ();  ///< of the centre-line there, unit
    double radius_mm = 0.0;     ///< of the lumen there
    std::vector<Vec3>
        path;  ///< the centre-line through the station; it ends beyond the piece, or where the vessel does
    std::vector<double> arc;     ///< (path) mm along it, 0 at the station, rising
    std::vector<Index> regions;  ///< of the stretch that is pushed: branches are not
};

/// The vessel wall near all stations, cut out of the anatomy; const, shared by all worlds.
struct StationWall {
    std::string anatomy;
    std::vector<Station> stations;
    TriMesh mesh;                 ///< of the fine surface; open where it was cut
    std::vector<Index> region;    ///< one a vertex
    std::vector<double> radius;   ///< one a vertex: of the lumen nearby
    std::vector<Region> regions;  ///< of the anatomy
    std::vector<FixedZone> fixed;
};

/// Stations as a scene names them; without any, one in the middle of each region whose lumen is aortic (7 mm in radius
/// or more) and in which there is room.  Throws UserError: a region or landmark that is not there (with the nearest
/// name), a region without centre-line, a place beyond its end or without room for the stretch that is pushed, two
/// stations too near to each other or of one name, no station at all.
StationWall station_wall(const AnatomyModel& anatomy, const SceneRig& rig);

/// Sampled as a scene's own wall is.  Held are the anatomy's fixed zones and the ends of the pieces.
Specimen station_specimen(const StationWall& wall, const SceneWall& scene, RigStress stress, std::uint64_t seed);

}  // namespace cathlab
