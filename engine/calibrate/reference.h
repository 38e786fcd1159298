// Reference curves as CSV files: what a calibration is to follow.
//
// Lines that begin with # are comments; the first other line names the columns, each with its unit; numbers follow.
// Columns that are not asked for are passed over.  Whatever is wrong is a UserError with file, line and column.
#pragma once

#include <string>
#include <vector>

#include "core/errors.h"

namespace cathlab {

/// Stress against strain, row by row.
struct StressStrain {
    std::vector<double> stress_kpa;  ///< either sign, |stress| <= 1e6
    std::vector<double> strain;      ///< (r - r0) / r0, a fraction, > -1
    std::vector<int> run;            ///< which recording a row belongs to; empty = one
    std::string file;                ///< for messages; may be empty
    std::vector<int> line;           ///< of each row in the file; may be empty
};

/// Throws UserError: fewer than three rows, columns of unequal length, numbers that are not finite or out of range, and
/// stress that turns round within a run (rising and falling are both right).
void check(const StressStrain& reference);

/// Columns stress_kpa, stress_mpa or stress_pa; strain or strain_percent; optionally run.
StressStrain read_stress_strain(const std::string& path);

/// The rows with low_kpa <= stress <= high_kpa; throws UserError where fewer than three are left.
StressStrain within(const StressStrain& reference, double low_kpa, double high_kpa);

/// The annulus along its axis over one beat.
struct BeatMotion {
    std::vector<double> phase;            ///< rising within [0, 1]
    std::vector<double> displacement_mm;  ///< |d| <= 40
    std::string file;                     ///< for messages; may be empty
    std::vector<int> line;                ///< of each row in the file; may be empty
};

/// Throws UserError: fewer than five rows, columns of unequal length, numbers that are not finite or out of range,
/// phases that do not rise, and rows for the phases 0 and 1 that disagree by more than 1e-6 mm.
void check(const BeatMotion& reference);

/// Columns phase, t_s or t_ms; displacement_mm, displacement_cm or displacement_m.
///   beat_s   length of the beat in which times are counted, > 0; rows must lie within one
BeatMotion read_beat_motion(const std::string& path, double beat_s);

/// Displacement at any phase: straight lines between the rows, and over the end of the beat to the first one.
double at_phase(const BeatMotion& reference, double phase);

}  // namespace cathlab
