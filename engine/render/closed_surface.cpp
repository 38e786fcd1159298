#include "render/closed_surface.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>

#include "core/errors.h"

namespace cathlab {

void require_closed(const TriMesh& mesh, const std::string& what) {
    const MeshFaults faults = find_faults(mesh);
    if (faults.sound()) return;
    const Vec3& p = faults.first_place;
    std::array<char, 96> place{};
    std::snprintf(place.data(), place.size(), "%.1f %.1f %.1f", p.x(), p.y(), p.z());
    throw UserError("X-rays: the surface of the " + what + " is not closed: " + std::to_string(faults.open_edges) +
                    " open and " + std::to_string(faults.non_manifold_edges) + " non-manifold edges, the first at " +
                    place.data() + " mm");
}

void require_before_source(const FrameDescription& frame, const Projection& projection, bool standing_too) {
    constexpr double clear_mm = 1.0;
    const Vec3 forward = projection.normal();
    const auto require = [&](const std::string& what, const auto& places, const auto& to_world) {
        double nearest = std::numeric_limits<double>::infinity();
        for (const Vec3& p : places) nearest = std::min(nearest, (to_world(p) - projection.source()).dot(forward));
        if (nearest >= clear_mm) return;
        throw UserError("C-arm: the " + what + " reaches " + std::to_string(std::lround(clear_mm - nearest)) +
                        " mm behind the X-ray source: a larger sod_mm or another isocentre or angle is wanted");
    };
    const auto as_it_is = [](const Vec3& p) -> const Vec3& { return p; };
    require("lumen", frame.lumen.vertices, as_it_is);
    for (const FrameSolid& solid : frame.solids)
        if (standing_too || solid.moving)
            require("patient's " + solid.material, solid.mesh.vertices,
                    [&](const Vec3& p) { return solid.pose.to_world(p); });
    for (const FrameDevice& device : frame.devices) require(device.name, device.points, as_it_is);
}

}  // namespace cathlab
