// The contact rows of one chain solve: which push, how they rub, and what they add to the chain's blocks.
//
// Normal: with d = (dx, dtheta) of the row's link and J = [n, arm x n], the row's law is
//   lambda' = lambda - (gap + J d) / c,   lambda' >= 0 unless bilateral;
// an active row adds J^T J / c to its link's block and J^T (lambda - gap / c) to the right-hand side.
//
// Friction: f' = -k (s' + z) with the slip s' = slip + P (dx + dtheta x arm) + c (f' - f), P = I - n n^T: the partner
// gives way sideways as it does along the normal.  k = min(k_0, mu lambda' / |s' + z|), k_0 = mu lambda' / s_0,
// s_0 = 0.5 mm/s x h, is Coulomb's law with a spring of stiffness k_0 in it, and z = -held / k_0 is by how much that
// spring is bent already when the substep begins: what does not move keeps its force, and none is lost to creep
// [haessig1991]. k is found over the passes.  A force that is linear in the slip inside the solve can never turn a
// light link round, as a constant sliding force would.
//
// Side drag: a wall is hollow across the wire, so a contact force holds the wire in the hollow like a spring lambda / R
// that the frozen normal hides from the solve; stepped explicitly it throws a light wire from side to side.  Blood
// takes the swing out: motion of the axis along b = n x wire, against the wall, feels -side_drag lambda b b^T s.  It is
// nothing at rest and belongs to neither the multiplier nor the friction (Rod::drag_mn reports it).
#pragma once

#include <span>

#include "rod/block_chain.h"
#include "rod/chain_row.h"

namespace cathlab {

class ChainRows {
public:
    /// Takes the rows.  Throws std::logic_error for an illegal row.
    /// axis = the links' unit axes, one a free link.
    void begin(std::span<const ChainRow> rows, std::span<const Vec3> axis, double h);

    /// Adds the rows of link i in their current state to its block.
    void add_to(std::size_t link, Mat6& diagonal, Vec6& right) const;

    /// Reads a link's part of the solution, finds the forces of its rows, and changes the state of those whose
    /// assumption failed: true where the link's block must be built anew.  `pass` counts from 0: the first passes may
    /// engage and release rows, later ones only take force away, so that the loop ends.  Links are independent of each
    /// other: any thread may ask for any of them.
    bool update(std::size_t link, const Vec6& moved, int pass);
    /// The same for the rows on links that are held, which no block has.
    void update_held(int pass);

    /// Sum of the side drags' forces on the links in the last update, mN.
    Vec3 side_force(const std::vector<Vec6>& solution) const;

    /// Writes multipliers and friction forces of the last update.
    void end(std::span<ChainRow> rows) const;

private:
    struct Work {
        ChainRow row;
        Vec6 jacobian;
        bool active = false;
        double rub = 0.0;             // k, mN/mm
        Vec3 bent = Vec3::Zero();     // z, mm
        double rub_with_wall = 0.0;   // k / (1 + k c)
        Vec6 side;                    // [b, arm x b]
        double side_stiffness = 0.0;  // mN/mm
        double multiplier = 0.0;      // found
        Vec3 tangent = Vec3::Zero();
    };

    void set_rub(Work& w, double load, const Vec3& slip, double share) const;
    bool update_normal(Work& w, const Vec6& d, bool may_engage) const;
    bool update_friction(Work& w, const Vec6& d, int pass) const;
    bool update_rows(std::size_t place, const Vec6& d, int pass);

    std::vector<Work> work_;
    std::vector<std::size_t> start_, order_;  // rows of link i: order_[start_[i]] .. order_[start_[i + 1] - 1]
    std::size_t free_links_ = 0;
    double rest_slip_ = 0.0;
};

}  // namespace cathlab
