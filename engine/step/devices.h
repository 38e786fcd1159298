// The devices' side of a substep: what the wire's drive takes and where the contact samples of both devices lie.
#pragma once

#include <span>
#include <vector>

#include "core/input.h"
#include "step/parts.h"

namespace cathlab {

/// Samples of both devices in one list for the contact room, with what the substep needs to bring them up to date.
struct DeviceSamples {
    std::vector<RodSample> wire;         ///< tip first
    std::vector<double> wire_arc;        ///< of each, mm from the wire's tip
    std::vector<std::size_t> wire_free;  ///< which of them lie outside the catheter: these meet the wall
    std::vector<Quat> link_before;       ///< orientation of every link when the substep began
    std::vector<Quat> link_turn;         ///< of every link since then,
    std::vector<Vec3> link_rotation;     ///< and its rotation vector, rad: both from refresh_samples
    std::vector<Vec3> catheter_before;   ///< where the points of the catheter's line now lay when the substep began, mm
    std::vector<DeviceSample> list;      ///< first the wire's free ones, then the catheter's, tip first
};

/// The part of the wanted advance that the drive of the wire takes, in [0, 1].  The rollers slip as the reaction at the
/// sheath comes near the device's max_push_n, and while the wire is pressed deeper into the wall than the limit;
/// pulling the other way is always allowed.
double drive_fraction(const Rod& wire, const WireDrive& drive, const StepSettings& settings, double advance_mm);

/// The same for the drive of a passive catheter over the wire.
double sleeve_drive_fraction(const Rod& wire, const WireDrive& drive, const StepSettings& settings, double advance_mm);

/// How far (mm) the wire slips through its drive within h seconds where what it is held against exceeds max_push_n: a
/// catheter around it may push or pull it harder than its own drive would.  Negative = out of the patient.
double drive_slip(const Rod& wire, double h);

/// Lists the samples as they are before the prediction (position = previous).
void begin_samples(const Parts& parts, const CatheterShape& catheter_before, DeviceSamples& samples);

/// Brings positions, arms and rotations of the wire's samples to where the chain is now: after whatever moves it.
void refresh_samples(const Parts& parts, DeviceSamples& samples);

}  // namespace cathlab
