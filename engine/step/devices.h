// The devices' side of a substep: how commands are taken and where the contact samples lie.
#pragma once

#include <span>
#include <vector>

#include "contact/inside_catheter.h"
#include "core/input.h"
#include "step/parts.h"

namespace cathlab {

/// Samples of both devices in one list for the contact room, with what the substep needs to bring them up to date.
struct DeviceSamples {
    std::vector<RodSample> wire;         ///< tip first
    std::vector<double> wire_arc;        ///< of each, mm from the wire's tip
    std::vector<std::size_t> wire_free;  ///< which of them lie outside the catheter: these meet the wall
    std::vector<Quat> link_before;       ///< orientation of every link when the substep began
    std::vector<DeviceSample> list;      ///< first the wire's free ones, then the catheter's, tip first
};

/// The part of the wanted advance that the drive of the wire takes, in [0, 1].  The rollers slip as the reaction at the
/// sheath comes near the device's max_push_n, and while the wire is pressed deeper into the wall than the limit;
/// pulling the other way is always allowed.
double drive_fraction(const Rod& wire, const WireDrive& drive, const StepSettings& settings, double advance_mm);

/// Takes of the catheter's command what the wall allows and moves it.  Returns the refused part, 0 to 1.
double move_catheter(Parts& parts, const Input& input, double h);

/// Brings the rail and the catheter's shape to where the wall is now, without a command.
void settle_catheter(Parts& parts);

/// Lists the samples as they are before the prediction (position = previous).
void begin_samples(const Parts& parts, const CatheterShape& catheter_before, DeviceSamples& samples);

/// Brings positions, arms and rotations of the wire's samples to where the chain is now.
void refresh_samples(const Parts& parts, DeviceSamples& samples);

/// The bore of the catheter for the wire inside it; empty where there is no catheter.
CatheterBore catheter_bore(const Parts& parts);

}  // namespace cathlab
