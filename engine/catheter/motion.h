// The catheter's state and how a command moves it within its rates and ranges.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "catheter/spec.h"
#include "core/archive.h"

namespace cathlab {

struct CatheterState {
    double insertion_mm = 0.0;     ///< length beyond the sheath's mouth, along the catheter
    double rotation_rad = 0.0;     ///< of the base about its axis since the start, right-handed about the forward axis
    std::vector<double> bend_rad;  ///< one a segment, >= 0, as taken
    std::vector<double>
        direction_rad;  ///< one a segment, in (-pi, pi]: the tip bends towards (cos, sin) of the base's x, y
    std::vector<double> taper =
        {};  ///< one a segment, or empty for none: how unevenly its bend lies along it (shape.h)
    std::vector<std::int64_t> route;  ///< nodes of the centre-line graph from the entry on (route.h)
};
void visit(Archive& archive, CatheterState& state);

/// All segments straight, nothing inserted.
CatheterState initial_state(const CatheterSpec& spec, double insertion_mm = 0.0);

/// What is wanted of one substep.  Bends and directions are targets, advance and rotation are increments.
struct CatheterCommand {
    double advance_mm = 0.0;
    double rotate_rad = 0.0;
    std::vector<double> bend_rad;       ///< one a segment; empty = stay
    std::vector<double> direction_rad;  ///< one a segment
};

/// The part of a command that is taken, each in [0, 1].
struct CatheterFraction {
    double advance = 1.0;
    double rotate = 1.0;
    std::vector<double> bend;  ///< one a segment; empty = 1
    static CatheterFraction all(const CatheterSpec& spec, double fraction);
};

/// The state after `fraction` of what the rates allow in h seconds.
/// Advance and rotation are cut to max_speed h and max_rotation h; insertion stays within [0, insertion_limit_mm] and
/// the catheter's length (a state already beyond stays, and may withdraw).  A segment's bend is the vector bend (cos
/// direction, sin direction) in its bend plane; the vector goes straight towards its target by at most max_rate h,
/// which is the shortest way, limits the swing of a bent segment and lets a straight one start in any direction. A
/// command that is not finite counts as zero.
CatheterState attempt(const CatheterSpec& spec, const CatheterState& state, const CatheterCommand& command,
                      const CatheterFraction& fraction, double h,
                      double insertion_limit_mm = std::numeric_limits<double>::infinity());
CatheterState attempt(const CatheterSpec& spec, const CatheterState& state, const CatheterCommand& command,
                      double fraction, double h, double insertion_limit_mm = std::numeric_limits<double>::infinity());

}  // namespace cathlab
