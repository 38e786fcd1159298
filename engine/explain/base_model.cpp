#include "explain/base_model.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/errors.h"
#include "core/units.h"

namespace cathlab {
namespace {

constexpr int most_harmonics = 8;
constexpr double rows_a_number = 10.0;  // training rows wanted for each free number of the beat

/// Before the first and after the last recorded beat the neighbouring beat's length goes on: those rows count too.
double continued_phase(const std::vector<double>& beats, double t) {
    const double inside = beat_phase(beats, t);
    if (!std::isnan(inside)) return inside;
    const bool before = t < beats.front();
    const double length = before ? beats[1] - beats[0] : beats.back() - beats[beats.size() - 2];
    const double phase = (t - (before ? beats.front() : beats.back())) / length;
    return phase - std::floor(phase);
}

}  // namespace

double beat_phase(const std::vector<double>& beats, double time_s) {
    const auto next = std::upper_bound(beats.begin(), beats.end(), time_s);
    if (next == beats.begin() || next == beats.end()) return std::numeric_limits<double>::quiet_NaN();
    const double begin = *(next - 1);
    return (time_s - begin) / (*next - begin);
}

BaseModel::BaseModel(const Dataset& data, const Split& split)
    : measured_(data.of_role(ColumnRole::measured)), held_out_(split.held_out) {
    const auto rows = static_cast<Eigen::Index>(data.rows());
    if (data.kind == "heart-motion") {
        const auto runs = static_cast<Eigen::Index>(data.run_names.size());
        const auto& beats = data.heart.beat_times_s;
        const bool beating =
            !beats.empty() && std::all_of(beats.begin(), beats.end(), [](const auto& b) { return b.size() >= 2; });
        const auto train = static_cast<double>(std::count(held_out_.begin(), held_out_.end(), 0));
        const Eigen::Index harmonics =
            beating ? std::clamp(static_cast<int>((train / rows_a_number - static_cast<double>(runs)) / 2.0), 1,
                                 most_harmonics)
                    : 0;
        basis_ = Matrix::Zero(rows, runs + 2 * harmonics);
        for (const std::string& run : data.run_names) names_.push_back("rest_" + run);
        for (Eigen::Index k = 1; k <= harmonics; ++k) {
            names_.push_back("beat_cos_" + std::to_string(k));
            names_.push_back("beat_sin_" + std::to_string(k));
        }
        for (Eigen::Index i = 0; i < rows; ++i) {
            const auto row = static_cast<std::size_t>(i);
            const auto run = static_cast<std::size_t>(data.run[row]);
            basis_(i, data.run[row]) = 1.0;
            for (Eigen::Index k = 1; k <= harmonics; ++k) {
                const double angle =
                    2.0 * units::pi * static_cast<double>(k) * continued_phase(beats[run], data.time_s[row]);
                basis_(i, runs + 2 * (k - 1)) = std::cos(angle);
                basis_(i, runs + 2 * (k - 1) + 1) = std::sin(angle);
            }
        }
    } else if (data.kind == "wall-tension") {
        basis_ = Matrix::Zero(rows, 1);
        names_ = {"compliance_per_kpa"};
        const DataColumn* stress = data.find("stress");
        for (Eigen::Index i = 0; i < rows; ++i) {
            const double value = stress->values[static_cast<std::size_t>(i)];
            basis_(i, 0) = std::isnan(value) ? 0.0 : value;
        }
    } else {
        throw UserError(
            data.folder + ": data of kind '" + data.kind +
            "' can be read, but this program cannot yet be its rig; it explains heart-motion and wall-tension");
    }
    for (const DataColumn* column : measured_) {
        Matrix fitted = basis_;
        for (Eigen::Index i = 0; i < rows; ++i) {
            const auto row = static_cast<std::size_t>(i);
            if (held_out_[row] != 0 || std::isnan(column->values[row])) fitted.row(i).setZero();
        }
        Matrix normal = fitted.transpose() * fitted;
        const double scale = normal.trace() / static_cast<double>(normal.rows());
        if (!(scale > 0.0))
            throw UserError(data.folder + ": the rows to be fitted hold no '" + column->name + "' with any input");
        // A trace of ridge: a run without training rows keeps the rest position 0 and does not spoil the others.
        normal.diagonal().array() += 1e-10 * scale;
        solve_.push_back(normal.ldlt().solve(fitted.transpose()));
    }
}

std::vector<std::vector<double>> BaseModel::residual(const std::vector<std::vector<double>>& effect) const {
    std::vector<std::vector<double>> out;
    for (std::size_t c = 0; c < measured_.size(); ++c) {
        const std::vector<double>& values = measured_[c]->values;
        Vector rest(basis_.rows());
        for (Eigen::Index i = 0; i < rest.size(); ++i) {
            const auto row = static_cast<std::size_t>(i);
            rest[i] = values[row] - (effect.empty() ? 0.0 : effect[c][row]);
        }
        Vector known = rest;
        for (Eigen::Index i = 0; i < known.size(); ++i)
            if (std::isnan(known[i])) known[i] = 0.0;
        const Vector left = rest - basis_ * (solve_[c] * known);
        out.emplace_back(left.data(), left.data() + left.size());
    }
    return out;
}

std::vector<std::pair<std::string, double>> BaseModel::parameters() const {
    std::vector<std::pair<std::string, double>> out;
    for (std::size_t c = 0; c < measured_.size(); ++c) {
        Vector known(basis_.rows());
        for (Eigen::Index i = 0; i < known.size(); ++i) {
            const double value = measured_[c]->values[static_cast<std::size_t>(i)];
            known[i] = std::isnan(value) ? 0.0 : value;
        }
        const Vector fitted = solve_[c] * known;
        for (std::size_t k = 0; k < names_.size(); ++k) {
            const double value = fitted[static_cast<Eigen::Index>(k)];
            if (names_[k] == "compliance_per_kpa")
                out.emplace_back("modulus_kpa", 1.0 / value);
            else
                out.emplace_back(names_[k] + "_" + measured_[c]->quantity, value);
        }
    }
    return out;
}

}  // namespace cathlab
