// How well the devices stay inside the wall, measured apart from what the step looks at: its samples, rows, margins,
// hints and its surface.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "contact/closest_point.h"
#include "core/winding.h"
#include "step/parts.h"

namespace cathlab {

inline constexpr double account_spacing_mm = 1.25;  ///< of the points along a device, at most

/// A sphere of a device that has to lie within the lumen.
struct DevicePoint {
    Index device = wire_device;
    double arc_mm = 0.0;  ///< from the device's tip
    Vec3 position = Vec3::Zero();
    double radius = 0.0;
};

/// Both devices tip first, finely all along: the wire outside the catheter's bore, the catheter from its own diameter
/// beyond the mouth of the sheath, which holds what is beside it.
inline std::vector<DevicePoint> device_points(const Parts& parts) {
    std::vector<DevicePoint> points;
    const CatheterShape* catheter = parts.catheter ? &parts.catheter_route->shape : nullptr;
    if (parts.wire) {
        const Rod& wire = *parts.wire;
        const bool hollow = catheter && parts.catheter->inner_diameter_mm > 0.0;
        const double bore_mm = hollow ? catheter->arc.back() : 0.0;
        std::vector<double> centre(wire.link_count());  // of the links, mm from the tip
        double start = 0.0;
        for (std::size_t i = 0; i < centre.size(); ++i) {
            centre[i] = start + 0.5 * wire.link_length(i);
            start += wire.link_length(i);
        }
        std::vector<RodSample> samples;
        wire.samples(account_spacing_mm, samples);
        for (const RodSample& s : samples) {
            const auto link = static_cast<std::size_t>(s.link);
            const double arc = centre[link] - s.arm.dot(wire.link_pose(link).orientation * Vec3::UnitZ());
            if (wire.insertion_mm() - arc >= bore_mm) points.push_back({wire_device, arc, s.position, s.radius});
        }
    }
    if (catheter) {
        for (std::size_t i = catheter->points.size(); i-- > 0;) {
            if (catheter->arc[i] < parts.catheter->outer_diameter_mm) break;
            points.push_back({catheter_device, catheter->arc.back() - catheter->arc[i], catheter->points[i],
                              parts.catheter->radius_mm()});
        }
    }
    return points;
}

struct InsideAccount {
    double deepest_mm = 0.0;  ///< of a sphere beyond the surface: radius - signed distance of its centre, >= 0
    DevicePoint deepest;      ///< where that is
    double deepest_in_coronaries_mm = 0.0;  ///< of those whose nearest wall is a coronary artery's
    int outside = 0;                        ///< centres beyond the wall by more than their radius
    std::size_t points = 0;                 ///< how many were looked at
};

/// Skins the whole surface to the particles as they are now and looks for the closest of all its points to every device
/// point, without a hint.  The side comes from that point's normal; where it says outside, and at either tip whatever
/// it says, the winding number decides: a vessel pressed into folds can turn a facet inside out.  Distance changes no
/// faster than the point moves, so the last point's distance and the way from there bound the search: it stays exact.
inline InsideAccount inside_account(const Parts& parts, LumenSurfaceState& surface) {
    update(*parts.surface, parts.wall_state->x, surface, parts.world->workers());
    InsideAccount account;
    const DevicePoint* last = nullptr;
    double last_distance = 0.0;
    const std::vector<DevicePoint> points = device_points(parts);
    for (const DevicePoint& point : points) {
        constexpr double rounding_mm = 1e-3;
        const double reach = last ? std::fabs(last_distance) + (point.position - last->position).norm() + rounding_mm
                                  : std::numeric_limits<double>::infinity();
        const SurfacePoint wall = closest(*parts.surface, surface, point.position, reach);
        if (!wall.found()) {
            ADD_FAILURE() << "no wall within " << reach << " mm of a device";
            return account;
        }
        double distance = wall.signed_distance;
        if (distance < 0.0 || !last || last->device != point.device) {
            const bool inside = winding(parts.surface->triangles, surface.vertices, point.position) > 0.5;
            distance = inside ? std::fabs(distance) : -std::fabs(distance);
        }
        const double depth = point.radius - distance;
        if (depth > account.deepest_mm) {
            account.deepest_mm = depth;
            account.deepest = point;
        }
        const auto region =
            static_cast<std::size_t>(parts.surface->triangle_region[static_cast<std::size_t>(wall.triangle)]);
        if (depth > account.deepest_in_coronaries_mm &&
            parts.anatomy->regions[region].name.find("coronary") != std::string::npos)
            account.deepest_in_coronaries_mm = depth;
        account.outside += distance < -point.radius ? 1 : 0;
        last = &point;
        last_distance = distance;
    }
    account.points = points.size();
    return account;
}

}  // namespace cathlab
