// What a calibration found, as a page to read and print.
#pragma once

#include <string>

#include "calibrate/heart_calibration.h"
#include "calibrate/wall_calibration.h"
#include "core/html_page.h"

namespace cathlab {

/// Rows of the table of figures: the names that [li2025] gives, first guess and best, in `unit` (factor times the
/// figures').
PageTable figure_table(const Figures& first, const Figures& best, const std::string& unit, double factor);

/// Curve (reference, first guess, best), error over stress, the swarm's path, figures, what was searched.
///   command   what made it, for the last line
Page wall_page(const StressStrain& reference, const WallSearch& search, const WallCalibration& found,
               const std::string& command);

/// The same over three beats.
Page heart_page(const HeartSearch& search, const HeartCalibration& found, const std::string& reference,
                const std::string& command);

}  // namespace cathlab
