#include "calibrate/station_piece.h"

#include <algorithm>
#include <cmath>

#include "core/errors.h"
#include "scene/wall_parameters.h"
#include "softbody/wall_sample.h"

namespace cathlab {
namespace {

constexpr double across_radii = 2.0;  // wall farther from the centre-line than this is another vessel's
constexpr double held_mm = 2.5;       // of the ends of a piece

std::size_t at(Index i) {
    return static_cast<std::size_t>(i);
}

bool on_piece(const Station& station, const Foot& foot, double margin_mm) {
    return std::fabs(foot.arc) <= station_kept_radii * station.radius_mm - margin_mm &&
           foot.across <= across_radii * station.radius_mm - margin_mm;
}

/// The part of a surface whose vertices satisfy a condition and hang together with `seeds`.
std::vector<std::uint8_t> connected(const TriMesh& mesh, const std::vector<std::uint8_t>& kept,
                                    const std::vector<std::uint8_t>& seeds) {
    std::vector<std::vector<Index>> next(mesh.vertices.size());
    for (const Triangle& t : mesh.triangles)
        if (kept[at(t[0])] && kept[at(t[1])] && kept[at(t[2])])
            for (int k = 0; k < 3; ++k) next[at(t[k])].push_back(t[(k + 1) % 3]);  // the neighbour has the other way
    std::vector<std::uint8_t> reached(mesh.vertices.size(), 0);
    std::vector<Index> open;
    for (std::size_t v = 0; v < seeds.size(); ++v)
        if (seeds[v] && !next[v].empty()) {
            reached[v] = 1;
            open.push_back(static_cast<Index>(v));
        }
    while (!open.empty()) {
        const Index v = open.back();
        open.pop_back();
        for (const Index w : next[at(v)])
            if (!reached[at(w)]) {
                reached[at(w)] = 1;
                open.push_back(w);
            }
    }
    return reached;
}

}  // namespace

Foot foot_on(const Station& station, const Vec3& p) {
    Foot best;
    double least = 1e300;
    for (std::size_t k = 1; k < station.path.size(); ++k) {
        const Vec3 way = station.path[k] - station.path[k - 1];
        const double t = (p - station.path[k - 1]).dot(way) / way.squaredNorm();
        const double inside = std::clamp(t, 0.0, 1.0);
        const Vec3 foot = station.path[k - 1] + inside * way;
        const double squared = (p - foot).squaredNorm();
        if (squared >= least) continue;
        least = squared;
        best.centre = foot;
        best.direction = way.normalized();
        best.arc = station.arc[k - 1] + inside * (station.arc[k] - station.arc[k - 1]);
        best.beyond = (k == 1 && t < 0.0) || (k + 1 == station.path.size() && t > 1.0);
    }
    best.across = std::sqrt(least);
    return best;
}

void cut_piece(const AnatomyModel& anatomy, const SceneRig& rig, StationWall& wall) {
    const TriMesh& fine = anatomy.fine;
    std::vector<bool> has_wall(wall.stations.size(), false);
    std::vector<std::uint8_t> kept(fine.vertices.size(), 0), seeds(kept);
    for (std::size_t v = 0; v < fine.vertices.size(); ++v)
        for (std::size_t g = 0; g < wall.stations.size(); ++g) {
            const Station& station = wall.stations[g];
            const double reach = station_kept_radii * station.radius_mm;
            if ((fine.vertices[v] - station.place).norm() > reach + across_radii * station.radius_mm) continue;
            const Foot foot = foot_on(station, fine.vertices[v]);
            if (!on_piece(station, foot, 0.0)) continue;
            kept[v] = 1;
            if (std::fabs(foot.arc) >= station_read_radii * station.radius_mm) continue;
            seeds[v] = 1;
            has_wall[g] = true;
        }
    for (std::size_t g = 0; g < wall.stations.size(); ++g)
        if (!has_wall[g])
            throw UserError(g < rig.stations.size() ? rig.stations[g].where : rig.where,
                            "'" + wall.stations[g].name + "' has no wall near its centre-line");
    const std::vector<std::uint8_t> reached = connected(fine, kept, seeds);
    std::vector<Index> number(fine.vertices.size(), -1);
    for (const Triangle& t : fine.triangles) {
        if (!reached[at(t[0])] || !reached[at(t[1])] || !reached[at(t[2])]) continue;
        Triangle own;
        for (int k = 0; k < 3; ++k) {
            Index& n = number[at(t[k])];
            if (n < 0) {
                n = static_cast<Index>(wall.mesh.vertices.size());
                wall.mesh.vertices.push_back(fine.vertices[at(t[k])]);
                wall.region.push_back(anatomy.fine_region[at(t[k])]);
                wall.radius.push_back(anatomy.fine_radius[at(t[k])]);
            }
            own[k] = n;
        }
        wall.mesh.triangles.push_back(own);
    }
}

Specimen station_specimen(const StationWall& wall, const SceneWall& scene, RigStress stress, std::uint64_t seed) {
    Specimen out;
    std::vector<Region> regions = wall.regions;
    out.own = apply_wall(scene, regions);
    std::vector<double> wanted, thickness;
    for (const Region& region : regions) thickness.push_back(region.wall_thickness_mm);
    for (const Index region : wall.region) wanted.push_back(regions[at(region)].particle_spacing_mm);
    out.sample = sample_wall(wall.mesh, wall.region, lumen_spacing(wanted, wall.radius), thickness, seed);

    const std::size_t n = out.sample.position.size();
    out.sample.along.assign(n, Vec3::Zero());
    std::vector<RoundGauge> rounds(wall.stations.size());
    for (std::size_t i = 0; i < n; ++i) {
        const Vec3& p = out.sample.position[i];
        bool held = true;
        double nearest = 1e300;
        for (std::size_t g = 0; g < rounds.size(); ++g) {
            const Station& station = wall.stations[g];
            const Foot foot = foot_on(station, p);
            rounds[g].centre.push_back(foot.centre);
            if (foot.across < nearest) {
                nearest = foot.across;
                out.sample.along[i] = foot.direction;
            }
            if (on_piece(station, foot, held_mm)) held = false;
            if (std::find(station.regions.begin(), station.regions.end(), out.sample.region[i]) ==
                    station.regions.end() ||
                foot.across > across_radii * station.radius_mm)
                continue;
            if (std::fabs(foot.arc) <= station_loaded_radii * station.radius_mm)
                rounds[g].loaded.push_back(static_cast<Index>(i));
            if (std::fabs(foot.arc) <= station_read_radii * station.radius_mm)
                rounds[g].read.push_back(static_cast<Index>(i));
        }
        for (const FixedZone& zone : wall.fixed) held = held || zone.contains(p);
        out.held.push_back(held ? 1 : 0);
    }
    for (std::size_t g = 0; g < rounds.size(); ++g) {
        rounds[g].axis = wall.stations[g].axis;
        out.gauges.push_back(round_gauge(out.sample, rounds[g], stress, wall.stations[g].name));
    }
    return out;
}

}  // namespace cathlab
