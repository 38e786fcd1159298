// The heart as a cylinder that pushes the aortic root: its profile over the beat, and where it stands.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/archive.h"
#include "core/errors.h"
#include "core/types.h"

namespace cathlab {

struct HeartKnot {
    double phase = 0.0;            ///< of the beat, [0, 1), 0 = onset of ventricular activation
    double displacement_mm = 0.0;  ///< of the cylinder along its axis from its rest pose
};

/// Const after load.  The rest pose of the anatomy is END-SYSTOLE, when the annulus stands nearest to the apex: there
/// the displacement is 0, and the cylinder pushes the root up, into the aorta, through diastole. Default profile:
/// excursion 11.6 mm [plonek2018]; end-systole at 0.45 of the beat, from QS2 = 546 - 2.1 rate ms at 67 beats a minute
/// [weissler1968]; the share of early filling (about two thirds of the rise) and the shape in between are assumptions.
struct HeartSpec {
    double rate_bpm = 67.0;        ///< beats a minute, 20 to 250
    double radius_mm = 18.0;       ///< of the cylinder
    double height_mm = 40.0;       ///< from its face down
    double rest_gap_mm = 0.0;      ///< the face stands this far below the annulus at rest, >= 0
    Vec3 tilt_rad = Vec3::Zero();  ///< rotation vector of the axis against the annulus' frame
    double initial_phase = 0.45;
    bool bonded = true;  ///< the annulus hangs on the cylinder, which then moves it both ways; false: it pushes only
    std::vector<HeartKnot> knots = default_knots(11.6);
    std::string source = "plonek2018, weissler1968";

    /// The default shape scaled to an excursion, mm.
    static std::vector<HeartKnot> default_knots(double excursion_mm);
};

/// Throws UserError: rate, radius, height out of range, fewer than two knots, phases that do not increase within [0,
/// 1).
void validate(const HeartSpec& spec, const SourcePlace& where = {});

struct HeartState {
    double phase = 0.0;  ///< [0, 1)
    double displacement_mm = 0.0;
    double velocity_mm_s = 0.0;  ///< of the cylinder along its axis
    std::int64_t beats = 0;      ///< completed since the start
};
void visit(Archive& archive, HeartState& state);

HeartState initial_state(const HeartSpec& spec);

/// Displacement and its slope (mm a beat) at a phase: periodic monotone cubic through the knots, continuously
/// differentiable, no overshoot between knots [fritsch1984].
struct ProfileValue {
    double displacement_mm, slope_mm;
};
ProfileValue profile(const HeartSpec& spec, double phase);

/// One step of dt seconds; rate_scale lets an effect vary the rate (1 = the spec's).
void advance(const HeartSpec& spec, HeartState& state, double dt, double rate_scale = 1.0);

/// The cylinder's frame: origin in the middle of its face, z = axis, from the ventricle into the aorta.
/// annulus = the annulus' rest frame (z into the aorta), moved by the supports if they move.
Pose cylinder_pose(const HeartSpec& spec, const Pose& annulus, double displacement_mm);

}  // namespace cathlab
