// The beam as stepped state: C-arm motion, pulses, automatic exposure and dose.  Pictures may be absent; the numbers
// are not.
#pragma once

#include <cstdint>

#include "beam/c_arm.h"
#include "beam/spectrum.h"
#include "core/archive.h"

namespace cathlab {

/// What the pedal exposes.  Fluoroscopy is looked at, cine is kept, a DSA series is subtracted from its first pictures.
enum class Acquisition : std::uint8_t { fluoroscopy, cine, dsa };

/// Dose of fluoroscopy: half, once and twice the target.
enum class FluoroscopyLevel : std::uint8_t { low, normal, high };

/// Const after load.  Defaults: a flat-panel cardiac system at normal fluoroscopic dose.
struct BeamSpec {
    CArmSpec c_arm;
    Vec3 isocentre = Vec3::Zero();  ///< world, mm
    double primary_deg = 0.0;       ///< at the start
    double secondary_deg = 0.0;
    double table_mm_s = 150.0;        ///< how fast the table goes (an assumption)
    double pulses_per_s = 15.0;       ///< 7.5, 15 or 30
    double target_kerma_ngy = 40.0;   ///< at the detector, per frame; 20 low, 40 normal, 80 high, 170 cine
    double cine_kerma_ngy = 170.0;    ///< of a cine picture
    double dsa_kerma_ngy = 3000.0;    ///< of a picture of a DSA series
    double dsa_pulses_per_s = 7.5;    ///< at most
    double lag_s = 0.5;               ///< time constant of the exposure control, 0.3 to 1 in practice
    double aluminium_mm = 2.5;        ///< inherent filtration
    double copper_mm = 0.3;           ///< added filtration
    double caesium_iodide_mm = 0.55;  ///< of the detector
    double kvp_min = 60.0, kvp_max = 120.0;
    double kvp_at_20_cm = 78.0;  ///< voltage curve: kVp = kvp_at_20_cm + kvp_per_cm (water - 20 cm), within its range
    double kvp_per_cm = 2.2;
    double mas_max = 4.0;             ///< of one pulse
    double mas_max_acquired = 100.0;  ///< of one pulse of cine or DSA (an assumption)
    double collimator_share_s = 1.0;  ///< how fast a pair of blades moves, shares of the field a second (an assumption)
    double tube_output_ugy_mas =
        45.0;  ///< air kerma 1 m from the focus per mAs at 80 kVp behind 2.5 mm Al (an assumption)
    double grid_transmission = 0.65;         ///< of the primary beam, anti-scatter grid and table (an assumption)
    double reference_point_mm = 150.0;       ///< from the isocentre towards the tube [iec60601-2-43]
    double kerma_rate_limit_mgy_min = 88.0;  ///< at the reference point, of fluoroscopy [cfr1020-32]
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
    Acquisition acquisition = Acquisition::fluoroscopy;  ///< what the pedal exposes
    FluoroscopyLevel level = FluoroscopyLevel::normal;
    std::int64_t series = 0;         ///< how often the pedal went down or changed what it exposes
    double collimator_width = 1.0;   ///< share of the field's width that is open, as reached
    double collimator_height = 1.0;  ///< likewise
    bool roadmap = false;            ///< the fluoroscopy is shown over the vessels of the last series with medium
    std::int64_t references = 0;     ///< how often the picture was kept as the reference
    bool reference_key = false;      ///< down during the last step
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
    Acquisition acquisition = Acquisition::fluoroscopy;
    FluoroscopyLevel level = FluoroscopyLevel::normal;
    double collimator_width = 1.0;   ///< wanted, share of the field, (0, 1]
    double collimator_height = 1.0;  ///< wanted
    bool roadmap = false;
    bool reference = false;  ///< the picture is kept as this goes up
};

/// What one pulse does, in closed form: kerma at distance r = output(kvp) mas (1 m / r)^2; the detector gets the part
/// that gets through the patient (water equivalent) and the grid.
struct Pulse {
    double kvp = 0.0, mas = 0.0;
    double detector_kerma_ngy = 0.0;
    double reference_kerma_mgy = 0.0;
    double dose_area_gycm2 = 0.0;
};

/// What the control is to reach, and within which limits.
struct Technique {
    double kerma_ngy = 40.0;     ///< at the detector, a picture
    double pulses_per_s = 15.0;  ///< a series of subtraction is slower
    double mas_max = 4.0;
    bool rate_limited = true;  ///< by kerma_rate_limit_mgy_min, which binds fluoroscopy, not what is recorded
    double open_share = 1.0;   ///< part of the field's area that the collimator leaves
};

/// For what the pedal exposes, with the collimator as it stands.
Technique technique_of(const BeamSpec& spec, const BeamState& state);

/// The pulse with which the control, set to set_water_mm, exposes a patient of true_water_mm.  The two-argument form:
/// fluoroscopy at normal dose, the whole field.
Pulse expose(const BeamSpec& spec, double set_water_mm, double true_water_mm, const Technique& technique);
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
