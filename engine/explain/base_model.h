// What the model says without any further effect: fitted on the training rows alone.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "explain/dataset.h"
#include "explain/split.h"

namespace cathlab {

/// A model that is linear in its free numbers, so that they are refitted exactly whenever an effect is tried beside
/// them.
///   heart-motion   one periodic beat (harmonics of the phase between recorded beats) and a rest position a run;
///   without
///                  recorded beats the rest position alone
///   wall-tension   strain = stress / modulus
class BaseModel {
public:
    /// Throws UserError where the kind's rig cannot be modelled yet, or the training rows do not determine the model.
    BaseModel(const Dataset& data, const Split& split);

    /// Measured columns, in the data's order.
    const std::vector<const DataColumn*>& measured() const { return measured_; }

    /// What is left of each measured column (columns x rows) when `effect` (the same shape, or empty) has been taken
    /// away and the base model was fitted to the rest on the training rows.  NaN where the measurement is.
    std::vector<std::vector<double>> residual(const std::vector<std::vector<double>>& effect) const;

    /// The fitted numbers without any effect: "modulus_kpa", "rest_0_displacement", ...
    std::vector<std::pair<std::string, double>> parameters() const;

private:
    using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic>;
    using Vector = Eigen::Matrix<double, Eigen::Dynamic, 1>;

    std::vector<const DataColumn*> measured_;
    std::vector<std::uint8_t> held_out_;
    std::vector<std::string> names_;  // of the basis' columns
    Matrix basis_;                    // (rows x free numbers)
    std::vector<Matrix> solve_;       // (free numbers x rows), one a measured column; zero columns for rows not fitted
};

/// Phase of the beat at a time, 0 to 1, and NaN before the first and after the last beat.
double beat_phase(const std::vector<double>& beats, double time_s);

}  // namespace cathlab
