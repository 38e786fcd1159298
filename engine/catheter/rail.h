// The rail: the smooth curve along which the catheter's shaft lies behind its segments.
#pragma once

#include <span>
#include <vector>

#include "core/types.h"

namespace cathlab {

/// A polyline with arc length and rotation-minimising frames.  Arc 0 = the sheath's mouth.
struct Rail {
    std::vector<Vec3> points;   ///< mm, world
    std::vector<double> arc;    ///< mm, from the mouth
    std::vector<Vec3> tangent;  ///< unit
    std::vector<Vec3> side;     ///< unit, square to the tangent: the frame's x axis
    /// How far a guidewire inside leads the steerable part, at each point: 0 = the segments alone decide, 1 = they
    /// follow the rail.  Empty = nowhere.
    std::vector<double> lead;

    double length() const { return arc.empty() ? 0.0 : arc.back(); }
    Vec3 point(double arc_mm) const;
    /// The frame at an arc length (z forward, x = side).  Beyond either end the rail goes on straight.
    Pose at(double arc_mm) const;
    /// The lead at an arc length, linear between points; beyond either end that of the end.
    double led(double arc_mm) const;
};

struct RailShape {
    double smoothing_radii = 0.75;  ///< half-width of either averaging along the route, in local lumen radii
    double smoothing_max_mm = 7.0;  ///< but no wider than this
    double deviation_limit = 0.4;   ///< the averaged node stays within this fraction of the local radius, < 1
};

/// Farthest that a node of the route can act backwards along the rail, mm: averaging, and two spans of 4 mm of the
/// spline.
double rail_support_mm(const RailShape& shape);

/// Averages the nodes along the route (triangular kernel, twice, symmetric, so a straight vessel stays straight), keeps
/// each within deviation_limit of its local radius, and runs a uniform cubic B-spline through them from the mouth.
/// `nodes`: current positions along the route; the first one is replaced by the mouth.  `radius`: one a node, or empty
/// for no averaging.  The frame starts with the mouth's x axis and is carried by double reflection [wang2008]. Throws
/// std::logic_error for fewer than two nodes.
Rail build_rail(const Pose& mouth, std::span<const Vec3> nodes, std::span<const double> radius,
                const RailShape& shape = {});

/// The rail that lies `share` (0 to 1) of the way from one rail to another, point by point of equal arc length, with
/// its lead.  It is as long as `to`: beyond the end of `from` it lies as far from `to` as there.  share = 1 is `to` to
/// the bit.
Rail blend(const Rail& from, const Rail& to, double share);

/// The rail of a shaft that slides over a wire.  Behind the tip it stays where it was laid, but for `yielding` (0 to 1)
/// of the way to the route; ahead of the tip it runs along the wire, and from the wire's end on along the route.  So
/// the wire leads by what is ahead of the catheter: what is inside it is bent by it and could not.  As long as `route`.
/// laid: without points = nothing laid yet.  wire: from the mouth; without points = none.
Rail laid_over_wire(const Rail& laid, const Rail& route, const Rail& wire, double tip_mm, double yielding);

/// How much a wire that reaches `wire_mm` beyond the mouth leads a base at `base_mm`: 0 at or behind the base, 1 from
/// `over_mm` beyond it, smooth between.
double wire_lead(double wire_mm, double base_mm, double over_mm = 20.0);

}  // namespace cathlab
