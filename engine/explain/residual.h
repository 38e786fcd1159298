// What is left when the model has been taken from the measurement: how large, how much of it is noise, and what it
// looks like.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/types.h"

namespace cathlab {

/// Root mean square over the rows whose flag equals `flag` (all rows where flags is empty); NaN values are left out.
double rms(std::span<const double> values, std::span<const std::uint8_t> flags = {}, std::uint8_t flag = 0);

/// Noise of a signal that is smooth between neighbours: 1.4826 median |r_{i+1} - 2 r_i + r_{i-1}| / sqrt 6 within runs.
/// Robust to outliers; too low where the noise itself is correlated.  NaN with fewer than three rows in a run.
double noise_by_differences(std::span<const double> values, std::span<const Index> run);

/// Correlation of neighbours within runs, -1 to 1: near 0 for white noise (standard error 1 / sqrt rows).
double lag_one_autocorrelation(std::span<const double> values, std::span<const Index> run);

/// Part of the values farther from their median than five robust standard deviations.
double outlier_part(std::span<const double> values);

struct SpectrumPeak {
    double period_s = 0.0;
    double amplitude = 0.0;    ///< of the fitted sine, in the values' unit
    double explained = 0.0;    ///< part of the variance, 0 to 1
    double false_alarm = 1.0;  ///< chance that white noise has a peak as high somewhere in the range
};

/// The highest peaks (at most `count`, highest first) between two periods; see highest_peak.
std::vector<SpectrumPeak> highest_peaks(std::span<const double> time_s, std::span<const double> values,
                                        std::span<const Index> run, double shortest_s, double longest_s,
                                        std::size_t count);

/// The highest peak of the Lomb and Scargle periodogram [lomb1976, scargle1982] with mean taken away: rows need not be
/// even.  Periods from twice the median step to the longest run.  period_s = 0 where there is too little data.
SpectrumPeak highest_peak(std::span<const double> time_s, std::span<const double> values, std::span<const Index> run);

}  // namespace cathlab
