// What a residual looks like: in words and numbers, and as simple shapes without a mechanism.
#pragma once

#include <optional>
#include <string>

#include "explain/judge.h"

namespace cathlab {

/// Something left over that has a form.
struct Structure {
    std::string what;        ///< "oscillation", "step", "offsets", "outliers", "correlation", "dependence"
    std::string depends_on;  ///< a measured column, or what it goes with
    double period_s = 0.0, amplitude = 0.0;
    std::string text;
};

/// The residual with a shape taken away that no mechanism makes: fitted on the rows that a fit may see.  An effect that
/// explains less than such a shape has not been found: it borrows from what the shape says better.
struct PlainShape {
    Structure says;
    Columns residual;
};

/// A sine of any period, with its own size and phase in every column.
std::optional<PlainShape> plain_oscillation(const Dataset& data, const Split& split, const Columns& residual);
/// A step: from one moment of one run to its end every column is shifted.
std::optional<PlainShape> plain_step(const Dataset& data, const Split& split, const Columns& residual,
                                     const LossScale& scale);

/// A named number for each row: an input, its rate, its direction, the way it went so far, time, run, beat phase and
/// number, every column that the kind does not know.
struct Regressor {
    std::string name;
    std::vector<double> values;  ///< (rows) NaN where not known
    bool groups = false;         ///< a number that only tells rows apart (a run)
};
std::vector<Regressor> regressors(const Dataset& data);

/// What is left, most telling first: oscillations, steps, offsets of runs, dependences that hold on held-out rows too,
/// outliers, correlation of neighbours.
std::vector<Structure> describe_structure(const Dataset& data, const Split& split, const Columns& residual,
                                          const LossScale& scale, std::uint64_t seed);

/// A sparse linear model of the residual over the regressors, their squares and the found periods: numbers without a
/// mechanism.
struct EmpiricalTerm {
    std::string column, regressor;
    double coefficient = 0.0;  ///< column's unit over the regressor's
};
struct EmpiricalModel {
    std::vector<EmpiricalTerm> terms;
    double held_out_rms = 0.0;  ///< with it
};
/// Forward selection, at most `most` terms a column, each by the held-out blocks' gain; nothing where none helps.
std::optional<EmpiricalModel> fit_empirical(const Dataset& data, const Split& split, const Columns& residual,
                                            const LossScale& scale, std::uint64_t seed, std::size_t most = 4);

}  // namespace cathlab
