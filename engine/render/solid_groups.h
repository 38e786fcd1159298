// The patient's solids as few surfaces as can be drawn together.  For this room's .cpp files only.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/mesh.h"
#include "core/parallel.h"
#include "render/frame_description.h"

namespace cathlab {

/// Solids of equal material in equal surroundings.
struct SolidGroup {
    std::string material, surrounding;
    bool moving = false;
    std::vector<std::size_t> solids, first_vertex;  ///< which of the frame's, and where theirs begin
    std::vector<Triangle> triangles;
    std::vector<Vec3> vertices;  ///< mm, world

    /// Where the solids stand in this frame.
    void place(const FrameDescription& frame, const Workers& workers);
};

class SolidGroups {
public:
    /// Anew where the frame's solids are others than last time.  Throws UserError on an open one.
    void update(const FrameDescription& frame);
    void forget() { known_ = false; }
    std::vector<SolidGroup>& all() { return groups_; }

private:
    std::vector<SolidGroup> groups_;
    std::uint64_t revision_ = 0;
    std::size_t count_ = 0;
    bool known_ = false;
};

}  // namespace cathlab
