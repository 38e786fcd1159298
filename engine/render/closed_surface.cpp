#include "render/closed_surface.h"

#include <array>
#include <cstdio>

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

}  // namespace cathlab
