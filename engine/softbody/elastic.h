// The elastic form of the wall: the shell of shell.h within the stepped solver.  Where the cluster form has the mean
// goal of a particle's clusters, this one has
//     goal_i = x_i + F_i(x) / k_i,
// F the shell's forces and k_i a bound on how stiffly the particle is held.  What the solver does with a goal then
// moves the particle by its compliance times (inertia + F + rows), so that at rest F + rows = 0 whatever step, number
// of passes and k_i: the wall is what E, nu and t say.  k_i only sets how quickly it gets there: within a substep a
// particle gives way as if it weighed m + k h^2.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "softbody/aligned.h"
#include "softbody/fibres.h"
#include "softbody/kernel.h"
#include "softbody/membrane.h"
#include "softbody/shell.h"

namespace cathlab {

/// Triangles in groups of eight lanes, one lane a triangle, its slots the particles that its bending sees, corners
/// first; empty lanes and slots repeat a particle without weight.
struct ElasticGroups {
    std::vector<std::int32_t> first_slot;            ///< (groups + 1) in slots
    AlignedVector<std::int32_t> place;               ///< (slots x 8) index of a particle's x among the coordinates
    AlignedVector<double> second;                    ///< (slots x 3 x 8) weights of second derivatives, 1/mm2
    AlignedVector<double> constant;                  ///< (groups x 13 x 8), see elastic.cpp
    std::vector<Index> group_of_slot;                ///< (slots)
    std::vector<std::int32_t> source_first, source;  ///< (n + 1), and where in slot_force a particle's forces stand

    std::size_t groups() const { return first_slot.empty() ? 0 : first_slot.size() - 1; }
    std::size_t slots() const { return place.size() / kernel::lanes; }
    std::vector<Index> triangle;  ///< (groups x 8) of the shell; -1 = an empty lane
    kernel::Elastic view(const Fibres& fibres, const double* scale, const double* law = nullptr) const;
    kernel::ElasticSources sources() const { return {source_first.data(), source.data()}; }
};

ElasticGroups pack_shell(const ShellModel& shell);

/// Asks `law` at every triangle as it stands at x (c, index = lane), and writes what makes the loops' stress that one
/// at x, and at_once times as stiff from there: out, (groups x 4 x 8), lanes [begin, end) of groups.
///     S(C) = at_once (S_elastic(C) - S_elastic(C at x)) + S_law
using AskLaw = std::function<void(const MembraneMaterial& material, MembranePoint& point)>;
void ask_law(const ShellModel& shell, const ElasticGroups& groups, const Fibres& fibres, const AskLaw& law,
             std::span<const Vec3> x, std::span<double> out, std::size_t begin, std::size_t end);

/// k_i at rest, mN/mm, as small as passes converge with: the largest eigenvalue of the wall's stiffness over k is 5/4.
/// A substep's first forces are those at x + h v, so that a shape of eigenvalue m goes by z^2 + 2 (m - 1) z - (m - 1) =
/// 0, which leaves the unit circle at m = 4/3.
std::vector<double> holding_stiffness(const ShellModel& shell, std::span<const Vec3> rest);

/// k_i now: that at rest times the largest factor by which a triangle round the particle has stiffened.
/// tangent: (groups x 8) as the forces wrote it; out: (n).
void hold_now(const ElasticGroups& groups, std::span<const double> at_rest, std::span<const double> tangent,
              std::span<double> out, std::size_t begin, std::size_t end);

}  // namespace cathlab
