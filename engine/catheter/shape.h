// Where the whole catheter lies: shaft along the rail, then arcs of constant curvature, links and tip.
#pragma once

#include <span>
#include <vector>

#include "catheter/motion.h"
#include "catheter/rail.h"

namespace cathlab {

inline constexpr double catheter_spacing_mm = 1.25;

/// Samples from the mouth to the tip.  Sample k counted FROM THE TIP is one place of the material, k spacings behind
/// the tip: that is how the samples of two shapes are matched when the insertion differs.
struct CatheterShape {
    std::vector<Vec3> points;  ///< mm, world; the first is the mouth (nothing inserted: the only one)
    std::vector<double> arc;   ///< of each point, mm along the catheter from the mouth
    Pose base;                 ///< start of the steerable part (or the mouth while that is not all out), z forward
    Pose tip;                  ///< z forward
};

/// The frame `length` along an arc that turns by `bend` towards `direction` (radians) of the frame's x, y: eq. 9 of
/// [li2025], R = Rz(phi) Ry(beta) Rz(-phi), p = (l / beta) [(1 - cos beta) cos phi, (1 - cos beta) sin phi, sin beta].
/// Exact for bend = 0 (straight on).
Pose along_arc(const Pose& start, double length, double bend, double direction);

/// The frame at the end of a segment of that length, bend (radians, towards the frame's x and y) and taper.
Pose segment_end(const Pose& start, double length, const Vec2& bend, double taper);

/// The catheter of a state on a rail.  The curvature of its steerable part is that of its own bends, and where a
/// guidewire leads it (Rail::lead) the mean of its own and the rail's, as of two elastic rods in one another.  What is
/// still inside the sheath is straight: the segments come out tip first, each with its curvature (bend / length), so
/// insertion moves nothing by a jump.  A segment with a taper t has the curvature bend / length (1 + t (2 s / length -
/// 1)) at s from its base, in six arcs.
CatheterShape shape(const CatheterSpec& spec, const CatheterState& state, const Rail& rail,
                    double spacing_mm = catheter_spacing_mm);

/// Arc of the base along the rail, mm; negative while the steerable part is not all out.
double base_arc_mm(const CatheterSpec& spec, const CatheterState& state);

/// The steerable part and, in a straight line, `prolonged_mm` beyond its tip: the guide that picks branches (route.h).
std::vector<Vec3> steering_guide(const CatheterSpec& spec, const CatheterShape& shape, double prolonged_mm = 20.0);

}  // namespace cathlab
