#include "step/wire_weight.h"

namespace cathlab {

std::vector<Vec3> wire_weight(const Rod& wire, const Vec3& gravity) {
    std::vector<Vec3> out;
    if (gravity == Vec3::Zero()) return out;
    for (std::size_t i = 0; i < wire.free_link_count(); ++i) out.push_back(wire.link_mass(i) * gravity);
    return out;
}

}  // namespace cathlab
