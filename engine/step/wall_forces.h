// What acts on the wall besides the devices: the heart's cylinder, anchors and forces of effects.
#pragma once

#include <span>
#include <vector>

#include "heart/cylinder_rows.h"
#include "step/parts.h"

namespace cathlab {

/// Lives for one substep.  Each kind keeps its own array until gather() sums them into the scratch force, in a fixed
/// order.
class WallForces {
public:
    /// Asks the effects: material (written to the scratch's stiffness_scale), constraint and force.
    WallForces(const Parts& parts, const EffectContext& context);

    /// Explicit forces for predict, mN, one a particle; empty where no effect adds one.
    std::span<const Vec3> external() const { return external_; }

    /// Moves the cylinder over h seconds and finds the particles that it may touch.
    void detect_heart(const Parts& parts, const Drive& drive, double h);

    /// One pass over the heart's rows and the anchors, each particle by its own compliance:
    ///   heart:   lambda' = max(0, lambda - gap / c)
    ///   anchor:  f = k (target - x_free) / (1 + c k),  x_free = x - c f_old: exact for what else acts on the particle
    void solve(const Parts& parts);

    /// Adds the particles that heart or anchors act on; repeats are possible.
    void add_touched(std::vector<Index>& particles) const;

    /// Scratch force = devices + heart + anchors, mN.
    void gather(const Parts& parts);

private:
    std::vector<Vec3> external_;
    std::vector<WallAnchor> anchors_;
    std::vector<Vec3> anchor_force_;  ///< one an anchor, mN
    std::vector<CylinderRow> rows_;
    std::vector<Index> written_;  ///< particles that the last gather gave a force; the others have none
};

}  // namespace cathlab
