// How smooth a movement was, from its speed profile.  Both measures are negative; nearer to 0 is smoother.
#pragma once

#include <span>

namespace cathlab {

/// Spectral arc length (SPARC) of a speed profile [balasubramanian2015, eq. 4]: with V(f) the amplitude spectrum over
/// its value at 0, zero-padded to 16 times the next power of two, and f_c the last frequency up to 10 Hz where V >=
/// 0.05,
///   SPARC = - integral from 0 to f_c of sqrt((1 / f_c)^2 + (dV/df)^2) df.
/// speed: mm/s, equally spaced by dt seconds.  A single reach gives about -1.5.  0 for a profile that is all zero or of
/// fewer than four samples: nothing moved, nothing to judge.  It depends on pauses; give it a movement, not a session.
double spectral_arc_length(std::span<const double> speed, double dt);

/// Log dimensionless jerk (LDLJ-V) of a speed profile:  - ln( T^3 / v_peak^2 * integral (d2v/dt2)^2 dt ), after a
/// low-pass of 10 Hz without phase shift.  0 under the same conditions as above.
double log_dimensionless_jerk(std::span<const double> speed, double dt);

}  // namespace cathlab
