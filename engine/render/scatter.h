// Scattered radiation: how much of it reaches the detector, from how thick the patient is and how much of him is lit.
#pragma once

namespace cathlab {

/// Scatter over primary at the detector, behind a grid and an air gap, for a patient of water_mm (water equivalent) lit
/// over a square of side_mm at the isocentre:
///     SPR = behind * 0.025 / mm * water_mm * side_mm / (side_mm + 110 mm),     behind = 0.1.
/// Without a grid that is 2.4, 3.2 and 3.7 behind 200 mm for sides of 100, 200 and 300 mm, and 5.5 behind 300 mm: the
/// range of measurements and of Monte Carlo for wide beams.  `behind` is a grid that lets through a fifth as much of
/// the scatter as of the primary, and a gap of some 250 mm of air that halves it.  (Both an assumption.) Negative
/// thicknesses count as 0.
double scatter_to_primary(double water_mm, double side_mm);

}  // namespace cathlab
