#include "take_poses.h"

#include <algorithm>
#include <cmath>

#include "contrast/transport.h"
#include "core/units.h"
#include "step/parts.h"

namespace cathlab {
namespace {

// So far behind its mouth a guiding catheter gives way to the ostium's motion.
constexpr double guide_bends_mm = 60.0;

// A guiding catheter does not follow the corners of a centre-line where a branch begins.
std::vector<Vec3> rounded(std::vector<Vec3> points) {
    constexpr int passes = 80;  // of weights 1/4, 1/2, 1/4: together a Gaussian of sqrt(passes / 2) points
    for (int pass = 0; pass < passes; ++pass) {
        Vec3 before = points.front();
        for (std::size_t i = 1; i + 1 < points.size(); ++i) {
            const Vec3 here = points[i];
            points[i] = 0.25 * before + 0.5 * here + 0.25 * points[i + 1];
            before = here;
        }
    }
    return points;
}

// A guided wire is drawn on through the guiding catheter, whose own wall is not drawn.
DevicePose wire_pose(const Rod& wire, const GuidePath* guide) {
    DevicePose out;
    out.name = wire_entity;
    out.points = wire.polyline();
    if (guide) out.points.resize(wire.free_link_count() + 1);
    for (std::size_t i = 0; i + 1 < out.points.size(); ++i) {
        out.radius_mm.push_back(wire.link_radius(i));
        out.material_of.push_back(out.material_index(wire.material(i)));
    }
    if (!guide) return out;
    const Vec3 moved = wire.sheath().mouth.position - guide->points.front();
    double behind = 0.0;
    const std::vector<Vec3> path = rounded(guide->points);
    for (std::size_t i = 0; i < path.size(); ++i) {
        if (i > 0) behind += (path[i] - path[i - 1]).norm();
        out.points.push_back(path[i] + std::max(0.0, 1.0 - behind / guide_bends_mm) * moved);
        out.radius_mm.push_back(out.radius_mm.back());
        out.material_of.push_back(out.material_of.back());
    }
    return out;
}

DevicePose catheter_pose(const CatheterSpec& spec, const CatheterShape& shape) {
    DevicePose out;
    out.name = catheter_entity;
    out.points = shape.points;
    const double band = shape.arc.back() - spec.tip_marker_length_mm;
    for (std::size_t i = 0; i + 1 < out.points.size(); ++i) {
        out.radius_mm.push_back(spec.radius_mm());
        out.inner_radius_mm.push_back(0.5 * spec.inner_diameter_mm);
        const bool marker = 0.5 * (shape.arc[i] + shape.arc[i + 1]) >= band;
        out.material_of.push_back(out.material_index(marker ? spec.tip_material : spec.material));
    }
    return out;
}

// A triangle's contact force is felt at its three corners.
void take_wall_force(const Parts& parts, std::vector<std::pair<Index, double>>& out) {
    const std::vector<Triangle>& triangles = parts.surface->triangles;
    std::vector<Vec3> force_mn(triangles.size(), Vec3::Zero());
    parts.contacts->add_triangle_forces(force_mn);
    out.clear();
    for (std::size_t t = 0; t < force_mn.size(); ++t) {
        if (force_mn[t].isZero()) continue;
        const double newtons = std::sqrt(force_mn[t].squaredNorm()) / units::newton;
        for (const Index corner : triangles[t]) out.emplace_back(corner, newtons);
    }
    std::stable_sort(out.begin(), out.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    std::size_t count = 0;
    for (const auto& [vertex, newtons] : out) {
        if (count > 0 && out[count - 1].first == vertex)
            out[count - 1].second += newtons;
        else
            out[count++] = {vertex, newtons};
    }
    out.resize(count);
}

// From the tip of whichever device has gone further.
std::optional<ScenePoses::Tip> tip_of(const Parts& parts) {
    const double wire_mm = parts.wire ? parts.wire->insertion_mm() : -1.0;
    const double catheter_mm = parts.catheter ? parts.catheter_state->insertion_mm : -1.0;
    if (parts.catheter && catheter_mm >= wire_mm) {
        const Pose& tip = parts.catheter_route->shape.tip;
        return ScenePoses::Tip{tip.position, tip.orientation * Vec3::UnitZ()};
    }
    if (!parts.wire) return std::nullopt;
    const std::vector<Vec3> points = parts.wire->polyline();
    return ScenePoses::Tip{points[0], (points[0] - points[1]).normalized()};
}

}  // namespace

FrameStage stage_of(World& world) {
    const Parts parts = find_parts(world);
    return {parts.anatomy, parts.beam, &world.workers()};
}

PosesFrame poses_frame(const AnatomyModel& anatomy) {
    return {&anatomy.lumen.vertices, anatomy.centreline.nodes.size(), anatomy.content_hash};
}

void take_poses(World& world, ScenePoses& out) {
    const Parts parts = find_parts(world);
    out.lumen = parts.surface_state->vertices;
    take_wall_force(parts, out.wall_force_n);
    out.contrast_mg_ml.clear();
    if (const auto* contrast = world.first<ContrastState>()) {
        const auto& c = contrast->concentration;
        if (std::any_of(c.begin(), c.end(), [](double mg_ml) { return mg_ml > 0.0; })) out.contrast_mg_ml = c;
    }
    out.devices.clear();
    if (parts.catheter) out.devices.push_back(catheter_pose(*parts.catheter, parts.catheter_route->shape));
    if (parts.wire) out.devices.push_back(wire_pose(*parts.wire, world.first<GuidePath>()));
    out.tip = tip_of(parts);
}

}  // namespace cathlab
