// The beam as stepped state: C-arm motion, pulses, automatic exposure and dose.  Pictures may be absent; the numbers
// are not.
#pragma once

#include <cstdint>

#include "beam/c_arm.h"
#include "beam/spectrum.h"
#include "core/archive.h"

namespace cathlab {

/// Const after load.  Defaults: a flat-panel cardiac system at normal fluoroscopic dose.
struct BeamSpec {
    CArmSpec c_arm;
    Vec3 isocentre = Vec3::Zero();  ///< world, mm
    double primary_deg = 0.0;       ///< at the start
    double secondary_deg = 0.0;
    double table_mm_s = 150.0;        ///< how fast the table goes (an assumption)
    double pulses_per_s = 15.0;       ///< 7.5, 15 or 30
    double target_kerma_ngy = 40.0;   ///< at the detector, per frame; 20 low, 40 normal, 80 high, 170 cine
    double lag_s = 0.5;               ///< time constant of the exposure control, 0.3 to 1 in practice
    double aluminium_mm = 2.5;        ///< inherent filtration
    double copper_mm = 0.3;           ///< added filtration
    double caesium_iodide_mm = 0.55;  ///< of the detector
    double kvp_min = 60.0, kvp_max = 120.0;
    double kvp_at_20_cm = 78.0;  ///< voltage curve: kVp = kvp_at_20_cm + kvp_per_cm (water - 20 cm), within its range
    double kvp_per_cm = 2.2;
    double mas_max = 4.0;  ///< of one pulse
    double tube_output_ugy_mas =
        45.0;  ///< air kerma 1 m from the focus per mAs at 80 kVp behind 2.5 mm Al (an assumption)
    double grid_transmission = 0.65;         ///< of the primary beam, anti-scatter grid and table (an assumption)
    double reference_point_mm = 150.0;       ///< from the isocentre towards the tube [iec60601-2-43]
    double kerma_rate_limit_mgy_min = 88.0;  ///< at the reference point [cfr1020-32]
};

/// Throws UserError: a rate that is not 7.5, 15 or 30, numbers out of range, a reference point behind the tube.
void validate(const BeamSpec& spec, const SourcePlace& where = {});

/// One number a state field that a score or a log depends on.
struct BeamState {
    double primary_deg = 0.0;            ///< as reached, + = LAO
    double secondary_deg = 0.0;          ///< as reached, + = cranial
    double table_longitudinal_mm = 0.0;  ///< as reached, + = towards the feet
    double table_lateral_mm = 0.0;       ///< as reached, + = towards the patient's right
    bool pedal = false;                  ///< beam on during the last step
    double water_mm = 200.0;             ///< thickness to which the exposure is set: the true one, lagged
    double kvp = 80.0;                   ///< chosen for it
    double mas = 0.0;                    ///< of a pulse
    double detector_kerma_ngy = 0.0;     ///< of the last frame, behind the true thickness
    double air_kerma_mgy = 0.0;          ///< cumulative, at the reference point
    double kerma_rate_mgy_min = 0.0;     ///< there, now; 0 while the pedal is up
    double dose_area_gycm2 = 0.0;        ///< cumulative
    double beam_time_s = 0.0;            ///< cumulative pedal time
    std::int64_t frames = 0;             ///< pulses since the start
};
void visit(Archive& archive, BeamState& state);

BeamState initial_state(const BeamSpec& spec);

/// Whether a pulse falls into step `step` (0, 1, ...) of dt seconds: floor((step + 1) dt rate) > floor(step dt rate).
bool pulse_in_step(std::int64_t step, double dt, double pulses_per_s);

struct BeamCommand {
    double primary_deg = 0.0;  ///< wanted
    double secondary_deg = 0.0;
    bool pedal = false;
    double table_longitudinal_mm = 0.0;  ///< wanted
    double table_lateral_mm = 0.0;
};

/// What one pulse does, in closed form: kerma at distance r = output(kvp) mas (1 m / r)^2; the detector gets the part
/// that gets through the patient (water equivalent) and the grid.
struct Pulse {
    double kvp = 0.0, mas = 0.0;
    double detector_kerma_ngy = 0.0;
    double reference_kerma_mgy = 0.0;
    double dose_area_gycm2 = 0.0;
};

/// The pulse with which the control, set to set_water_mm, exposes a patient of true_water_mm.
Pulse expose(const BeamSpec& spec, double set_water_mm, double true_water_mm);

/// Air kerma per mAs at 1 m behind the filters, uGy, at a voltage.
double tube_output_ugy_mas(const BeamSpec& spec, double kvp);

/// Where the isocentre stands in the patient, who lies on the table (x to the left, z to the head), mm.
Vec3 isocentre_in_patient(const BeamSpec& spec, double table_longitudinal_mm, double table_lateral_mm);

/// One step: the angles turn towards the command at most c_arm.rotation_deg_s, the table goes at most table_mm_s; while
/// the pedal is down the set thickness follows water_mm (equivalent thickness of water on the central ray, from the
/// caller, clamped to 0 to 600) with first-order lag, and each pulse adds dose.  True if a pulse fell into this step:
/// then there is a new frame.
bool advance(const BeamSpec& spec, BeamState& state, const BeamCommand& command, double water_mm, std::int64_t step,
             double dt);

}  // namespace cathlab
