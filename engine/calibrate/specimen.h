// A rig's piece of wall: its particles, what is held, how stress pushes on it, and where strain is read.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "calibrate/wall_rig.h"
#include "softbody/model.h"

namespace cathlab {

/// One place at which a stress acts and a strain is read.
struct Gauge {
    std::string name;
    double radius_mm = 0.0;     ///< of the lumen there; 0 = flat
    double thickness_mm = 0.0;  ///< of the wall
    /// (n) mN a kPa of stress by the section at rest (paper: of radial traction); its direction is that at rest.
    std::vector<Vec3> push;
    /// Strain with the particles at x (n, mm): of a round wall the mean of (r - r0) / r0 with r = |x - x_c| across the
    /// centre-line [li2025, eq. 4], where x_c moves along with the section; of a flat one the slope of the displacement
    /// along the pull.
    std::function<double(std::span<const Vec3> x)> strain;
};

struct Specimen {
    WallSample sample;
    std::vector<std::uint8_t> held;  ///< (n)
    std::vector<RegionWall> own;     ///< of regions with values of their own
    std::vector<Gauge> gauges;
    /// Called after each step: what plates and guides do that no load does.  May be empty.
    std::function<void(std::span<Vec3> x, std::span<Vec3> v)> guide;
};

/// Throws UserError for a rig that check() refuses, and for a wall that cannot be sampled.
Specimen make_specimen(const WallRig& rig, const SceneWall& wall);

/// The particles of a surface: its own vertices, each with a third of the triangles round it, so that free edges stand
/// where the surface ends.  Vertices of any spacing; one region of one thickness.
WallSample sample_of_mesh(const TriMesh& mesh, double thickness_mm);

/// A flat sheet, x from 0 to length, y from 0 to width, z = 0, outward = +z; rows of points stand at both ends.
TriMesh sheet_mesh(double length_mm, double width_mm, double edge_mm);

/// A gauge round a centre-line.
struct RoundGauge {
    std::vector<Index> loaded;  ///< particles that are pushed
    std::vector<Index> read;    ///< particles whose strain is read
    std::vector<Vec3> centre;   ///< (n) the point of the centre-line across from each particle; of those named above
    Vec3 axis = Vec3::UnitZ();  ///< of the section that is read, unit
};
/// Throws UserError where nothing is loaded or read, and where a particle stands on the centre-line.
Gauge round_gauge(const WallSample& sample, const RoundGauge& round, RigStress stress, const std::string& name);

}  // namespace cathlab
