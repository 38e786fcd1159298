// The wire cut into rigid links along its material, tip first, with what each link and joint weighs and how it gives
// way. Link i and its material never part: pushing the wire in adds links at the far end of the list.
#pragma once

#include "core/types.h"
#include "rod/wire_spec.h"

namespace cathlab {

struct WireLink {
    double start = 0.0;   ///< arc length from the tip of the wire to the link's front end, mm
    double length = 0.0;  ///< mm
    double radius = 0.0;  ///< mm
    double mass = 0.0;    ///< kg
    double inertia_across = 0.0, inertia_along = 0.0;  ///< of a solid cylinder about its centre, kg mm2
    double bend = 0.0, twist = 0.0, axial = 0.0;       ///< EI, GJ in mN mm2; EA in mN
    double curvature = 0.0;                            ///< rest curvature, 1/mm: a turn about the link's x axis
    double curvature_side = 0.0;                       ///< the same about its y axis
    Index section = 0;

    double end() const { return start + length; }
    double centre() const { return start + 0.5 * length; }
};

/// Cuts every section into equal links, so that a border between sections is a joint.  spec must have passed
/// validate().
std::vector<WireLink> cut_into_links(const WireSpec& spec);

/// How the joint behind link a (before link b) resists: k_axial [mN/mm], k_bend and k_twist [mN mm per rad].
struct JointStiffness {
    double axial = 0.0, bend = 0.0, twist = 0.0;
    Quat rest = Quat::Identity();  ///< q_b = q_a * rest when unloaded
    bool curved = false;           ///< rest is not the identity
    double span = 0.0;             ///< free material that the joint stands for, mm
};

/// The joint stands for the material between the two links' centres, of which only what lies beyond the sheath's mouth
/// (arc length < insertion) can give way: 1/k_bend = integral of ds / EI, and likewise for GJ and EA.  This makes the
/// clamp second order accurate and lets a link pass the mouth without a jump in stiffness.  A joint with no free
/// material keeps a hundredth of its compliance, so that the system stays well scaled.
/// turn: angle by which a's frame stands turned about the axis against b's when unloaded.
JointStiffness joint_stiffness(const WireLink& a, const WireLink& b, double insertion, double turn = 0.0);

}  // namespace cathlab
