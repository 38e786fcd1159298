// How far a simulated curve is from its reference, in the figures that [li2025] gives.
#pragma once

#include <span>

namespace cathlab {

/// Of the differences e = simulated - reference, in the curve's own unit.
struct Figures {
    double rmse = 0.0;            ///< root mean square
    double mean = 0.0, sd = 0.0;  ///< of e; sd with n - 1, 0 for a single one
    double mean_absolute = 0.0, sd_absolute = 0.0;
    double median = 0.0;   ///< of |e|
    double p90 = 0.0;      ///< 90th percentile of |e|, interpolated between ranks
    double maximum = 0.0;  ///< of |e|
};

/// NaN throughout where there are no differences or one of them is not finite.
Figures figures_of(std::span<const double> differences);

/// Of two curves of the same length.
Figures figures_of(std::span<const double> simulated, std::span<const double> reference);

}  // namespace cathlab
