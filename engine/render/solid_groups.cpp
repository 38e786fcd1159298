#include "render/solid_groups.h"

#include <map>
#include <tuple>
#include <utility>

#include "render/closed_surface.h"

namespace cathlab {

void SolidGroup::place(const FrameDescription& frame, const Workers& workers) {
    workers.for_ranges(solids.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) {
            const FrameSolid& solid = frame.solids[solids[k]];
            const Mat3 turn = solid.pose.orientation.toRotationMatrix();
            Vec3* to = vertices.data() + first_vertex[k];
            for (const Vec3& p : solid.mesh.vertices) *to++ = turn * p + solid.pose.position;
        }
    });
}

void SolidGroups::update(const FrameDescription& frame) {
    if (known_ && revision_ == frame.solids_revision && count_ == frame.solids.size()) return;
    std::map<std::tuple<std::string, std::string, bool>, SolidGroup> found;
    for (std::size_t i = 0; i < frame.solids.size(); ++i) {
        const FrameSolid& solid = frame.solids[i];
        require_closed(solid.mesh, "solid of " + solid.material);
        if (solid.mesh.empty()) continue;
        SolidGroup& group = found[{solid.material, solid.surrounding, solid.moving}];
        group.material = solid.material;
        group.surrounding = solid.surrounding;
        group.moving = solid.moving;
        group.solids.push_back(i);
        group.first_vertex.push_back(group.vertices.size());
        const Triangle shift = Triangle::Constant(static_cast<Index>(group.vertices.size()));
        for (const Triangle& t : solid.mesh.triangles) group.triangles.emplace_back(t + shift);
        group.vertices.resize(group.vertices.size() + solid.mesh.vertices.size());
    }
    groups_.clear();
    for (auto& [media, group] : found) groups_.push_back(std::move(group));
    revision_ = frame.solids_revision;
    count_ = frame.solids.size();
    known_ = true;
}

}  // namespace cathlab
