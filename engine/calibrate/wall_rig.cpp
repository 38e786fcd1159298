#include "calibrate/wall_rig.h"

#include <array>
#include <cmath>

#include "anatomy/build.h"
#include "calibrate/stations.h"
#include "core/check.h"
#include "core/errors.h"
#include "scene/anatomy_file.h"

namespace cathlab {
namespace {

constexpr double ring_width_mm = 10.0, strip_width_mm = 12.0, block_mm = 20.0;
constexpr double least_tube_radii = 3.0, least_strip_widths = 3.0;
constexpr std::array<std::string_view, 5> kind_names{"tube", "stations", "ring", "strip", "block"};

RigKind kind_of(const SceneRig& rig, bool straight_tube) {
    if (rig.kind == "auto") return straight_tube && rig.stations.empty() ? RigKind::tube : RigKind::stations;
    for (std::size_t k = 0; k < kind_names.size(); ++k)
        if (rig.kind == kind_names[k]) return static_cast<RigKind>(k);
    throw UserError(rig.where, "kind: found '" + rig.kind + "'; auto, tube, stations, ring, strip or block is wanted");
}

struct StraightTube {
    TubeShape shape;
    double thickness_mm = 1.0;
    std::string not_one;  ///< why the anatomy is none; "" = it is
};

StraightTube straight_tube(const SceneSpec& scene) {
    StraightTube out;
    if (scene.anatomy.file.empty()) {
        out.not_one = "this anatomy is a mesh";
        return out;
    }
    const AnatomySpec anatomy = load_anatomy(scene.anatomy.file);
    if (anatomy.vessels.size() != 1) {
        out.not_one = scene.anatomy.file + " has " + std::to_string(anatomy.vessels.size()) + " vessels";
        return out;
    }
    const VesselSpec& vessel = anatomy.vessels.front();
    const auto point = [&](std::size_t i) {
        return Vec3(vessel.points[i][0], vessel.points[i][1], vessel.points[i][2]);
    };
    out.shape.closed = false;
    out.shape.edge_mm = WallRig{}.shape.edge_mm;
    out.shape.start = point(0);
    const Vec3 way = point(vessel.points.size() - 1) - out.shape.start;
    out.shape.length_mm = std::sqrt(way.squaredNorm());
    out.shape.axis = way / out.shape.length_mm;
    out.shape.radius_mm = vessel.points.front()[3];
    for (std::size_t i = 0; i < vessel.points.size(); ++i) {
        const Vec3 off = point(i) - out.shape.start;
        if (std::fabs(vessel.points[i][3] - out.shape.radius_mm) > 1e-9) out.not_one = "the radius of this one changes";
        if ((off - off.dot(out.shape.axis) * out.shape.axis).squaredNorm() > 1e-12) out.not_one = "this one is bent";
    }
    for (const RegionSpec& region : anatomy.regions)
        if (region.name == vessel.region) out.thickness_mm = region.wall_thickness_mm;
    for (const SceneWallRegion& own : scene.wall.regions)
        if (own.name == vessel.region && own.wall_thickness_mm) out.thickness_mm = *own.wall_thickness_mm;
    return out;
}

AnatomyModel rig_anatomy(const SceneSpec& scene, const RigOptions& options) {
    const Workers workers(options.threads);
    if (!scene.anatomy.imported.mesh.empty()) {
        ImportedAnatomySpec imported = scene.anatomy.imported;
        imported.where = scene.anatomy.where;
        return load_or_build(imported, options.cache_folder, workers, options.progress);
    }
    AnatomySpec anatomy = load_anatomy(scene.anatomy.file);
    anatomy.stenoses.insert(anatomy.stenoses.end(), scene.anatomy.stenoses.begin(), scene.anatomy.stenoses.end());
    if (scene.anatomy.face_count > 0) anatomy.meshing.face_count = scene.anatomy.face_count;
    return load_or_build(anatomy, options.cache_folder, workers, options.progress);
}

void refuse_idle_keys(const SceneRig& rig, RigKind kind) {
    const auto refuse = [&](const char* key, const char* whose) {
        throw UserError(rig.where, std::string(key) + " belongs to " + whose + "; this rig is of kind " +
                                       std::string(rig_name(kind)));
    };
    const bool flat = kind == RigKind::strip || kind == RigKind::block;
    if (rig.length_mm && !flat) refuse("length_mm", "a strip or a block");
    if (rig.width_mm && !flat && kind != RigKind::ring) refuse("width_mm", "a ring, a strip or a block");
    if (!rig.stations.empty() && kind != RigKind::stations) refuse("station", "kind stations");
}

void require(bool good, const std::string& what, double found, const std::string& wanted) {
    if (!good) throw UserError("the rig's " + what + " is " + std::to_string(found) + " mm; " + wanted + " is wanted");
}

void require_length(const std::string& what, double value) {
    constexpr double most_mm = 5000.0;
    require(value > 0.0 && value <= most_mm, what, value, "above 0 to 5000 mm");
}

}  // namespace

std::string_view rig_name(RigKind kind) {
    return kind_names.at(static_cast<std::size_t>(kind));
}

void check(const WallRig& rig) {
    if (rig.kind == RigKind::stations) {
        CATHLAB_CHECK(rig.stations, "a rig of stations has its wall");
        return;
    }
    require_length("thickness", rig.thickness_mm);
    if (rig.round()) {
        require_length("radius", rig.shape.radius_mm);
        require_length(rig.kind == RigKind::ring ? "width" : "length", rig.shape.length_mm);
        if (rig.kind == RigKind::tube)
            require(rig.shape.length_mm >= least_tube_radii * rig.shape.radius_mm, "length", rig.shape.length_mm,
                    "three radii or more, or its held ends would be felt in the middle,");
        return;
    }
    require_length("length", rig.length_mm);
    require_length("width", rig.width_mm);
    if (rig.kind == RigKind::strip)
        require(rig.length_mm >= least_strip_widths * rig.width_mm, "length", rig.length_mm,
                "three widths or more, or the held end would be felt in the middle of the strip,");
    if (rig.stress == RigStress::paper)
        throw UserError("the stress of a " + std::string(rig_name(rig.kind)) +
                        " is hoop (true) or nominal; paper is a traction on the inside of a round wall");
}

WallRig wall_rig(const SceneSpec& scene, const RigOptions& options) {
    const StraightTube tube = straight_tube(scene);
    WallRig rig;
    rig.kind = kind_of(scene.rig, tube.not_one.empty());
    refuse_idle_keys(scene.rig, rig.kind);
    if (rig.kind == RigKind::stations) {
        rig.stations = std::make_shared<const StationWall>(station_wall(rig_anatomy(scene, options), scene.rig));
        return rig;
    }
    const SourcePlace where = scene.rig.where.file.empty() ? scene.anatomy.where : scene.rig.where;
    if (!tube.not_one.empty())
        throw UserError(where, "a rig of kind " + std::string(rig_name(rig.kind)) +
                                   " wants one straight vessel of one radius; " + tube.not_one);
    rig.shape = tube.shape;
    rig.thickness_mm = tube.thickness_mm;
    const bool block = rig.kind == RigKind::block;
    rig.length_mm = scene.rig.length_mm.value_or(block ? block_mm : tube.shape.length_mm);
    rig.width_mm = scene.rig.width_mm.value_or(block ? block_mm : strip_width_mm);
    if (rig.kind == RigKind::ring) rig.shape.length_mm = scene.rig.width_mm.value_or(ring_width_mm);
    try {
        check(rig);
    } catch (const UserError& error) {
        throw UserError(where, error.what());
    }
    return rig;
}

}  // namespace cathlab
