// A command is a target: what part of it the wall allows.
#pragma once

#include <span>
#include <vector>

#include "catheter/shape.h"

namespace cathlab {

/// One sample of the catheter near the wall, at the pose from which the command starts (this substep's rail, nothing
/// taken).
struct WallLimit {
    Index point = 0;                 ///< index into that pose's points
    Vec3 normal = Vec3::UnitZ();     ///< unit, into the lumen
    double gap = 0.0;                ///< mm between the surfaces, positive = free
    double force = 0.0;              ///< mN now
    double penetration_limit = 0.5;  ///< mm, >= 0
    double force_limit = 3000.0;     ///< mN
};

/// The largest f in [0, 1] for which every sample, moved by f times its displacement d (accepted to attempted), keeps
///     gap + n.(accepted - start) + f n.d >= floor,   floor = -penetration_limit,
/// and, where force >= force_limit, floor = gap: no further in than it was.  A sample below its floor may not go
/// deeper; moving away (n.d >= 0) is always allowed.  Closed form: f = min over samples of (gap + n.(accepted - start)
/// - floor) / -n.d. Points are matched from the tip (shape.h); a sample that has no partner does not limit.
double allowed_fraction(std::span<const Vec3> start, std::span<const Vec3> accepted, std::span<const Vec3> attempted,
                        std::span<const WallLimit> limits);
/// The same with accepted = start.
double allowed_fraction(std::span<const Vec3> previous, std::span<const Vec3> attempted,
                        std::span<const WallLimit> limits);

/// What was taken of a command.
struct CatheterTaken {
    CatheterState state;
    CatheterShape shape;
    CatheterFraction fraction;
    double refused = 0.0;             ///< largest refused part of the axes that the command moves, 0 to 1
    double refused_advance_mm = 0.0;  ///< signed, within the rate limit
};

/// take() lets the PREDICTED penetration reach this part of the limit; the rest is for what a straight-line prediction
/// leaves out (the samples' paths and the wall are curved within a substep: 0.03 mm at full speed in a rigid vessel).
inline constexpr double predicted_share = 0.85;

/// Takes of the command what the wall allows: first the largest common part of all axes, then of what is left each axis
/// by itself, in the fixed order segment bends (base first), rotation, advance, each seeing what the ones before it
/// took. So a blocked advance does not block straightening, and straightening makes room for the advance.
CatheterTaken take(const CatheterSpec& spec, const CatheterState& state, const CatheterCommand& command,
                   const Rail& rail, std::span<const WallLimit> wall, double h,
                   double insertion_limit_mm = std::numeric_limits<double>::infinity());

}  // namespace cathlab
