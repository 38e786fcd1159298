#include "explain/structure.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/svg_plot.h"
#include "core/units.h"
#include "explain/linear_part.h"
#include "explain/residual.h"

namespace cathlab {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double significant = 0.01;

std::vector<double> seen_by_fit(const std::vector<double>& column, const Split& split) {
    std::vector<double> out = column;
    for (std::size_t i = 0; i < out.size(); ++i)
        if (split.held_out[i] != 0) out[i] = nan;
    return out;
}

std::string unit_of(const DataColumn& column) {
    return column.unit.empty() ? "" : " " + column.unit;
}

/// Sine, cosine and a constant in each run at one period; the residual without the first two.
Columns without_sine(const Dataset& data, const Split& split, const Columns& residual, double period) {
    constexpr std::size_t rows_a_part = 40;
    const bool own_phase = data.rows() >= rows_a_part * data.run_names.size();
    const auto parts = own_phase ? static_cast<Eigen::Index>(data.run_names.size()) : Eigen::Index{1};
    Basis basis = Basis::Zero(static_cast<Eigen::Index>(data.rows()), 3 * parts);
    for (std::size_t i = 0; i < data.rows(); ++i) {
        const auto row = static_cast<Eigen::Index>(i);
        const double angle = 2.0 * units::pi * data.time_s[i] / period;
        const Eigen::Index part = own_phase ? data.run[i] : 0;
        basis(row, 2 * part) = std::cos(angle);
        basis(row, 2 * part + 1) = std::sin(angle);
        basis(row, 2 * parts + part) = 1.0;
    }
    Columns out = residual;
    for (auto& column : out) {
        Eigen::VectorXd x = solve_linear(basis, column, split);
        x.tail(parts).setZero();
        subtract(basis, x, column);
    }
    return out;
}

double train_square(const Columns& residual, const Split& split) {
    const double r = rms_of(residual, split, 0);
    return r * r;
}

/// Means of a column's train rows by bins of a regressor, taken from all rows: how the column goes with it.
std::vector<double> without_bins(const std::vector<double>& column, const Regressor& by, const Split& split) {
    constexpr std::size_t most_bins = 12, rows_a_bin = 8;
    std::vector<double> sorted;
    for (std::size_t i = 0; i < column.size(); ++i)
        if (split.held_out[i] == 0 && !std::isnan(column[i]) && !std::isnan(by.values[i]))
            sorted.push_back(by.values[i]);
    if (sorted.size() < 3 * rows_a_bin) return column;
    std::sort(sorted.begin(), sorted.end());
    std::vector<double> edges;
    if (by.groups) {
        edges = sorted;
    } else {
        const std::size_t bins = std::min(most_bins, sorted.size() / rows_a_bin);
        for (std::size_t b = 1; b < bins; ++b) edges.push_back(sorted[b * sorted.size() / bins]);
    }
    edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
    std::vector<double> sum(edges.size() + 1, 0.0), count(edges.size() + 1, 0.0);
    const auto bin_of = [&](double v) {
        return static_cast<std::size_t>(std::upper_bound(edges.begin(), edges.end(), v) - edges.begin());
    };
    for (std::size_t i = 0; i < column.size(); ++i) {
        if (split.held_out[i] != 0 || std::isnan(column[i]) || std::isnan(by.values[i])) continue;
        sum[bin_of(by.values[i])] += column[i];
        count[bin_of(by.values[i])] += 1.0;
    }
    std::vector<double> out = column;
    for (std::size_t i = 0; i < out.size(); ++i) {
        if (std::isnan(by.values[i])) continue;
        const std::size_t b = bin_of(by.values[i]);
        if (count[b] > 0.0) out[i] -= sum[b] / count[b];
    }
    return out;
}

}  // namespace

std::optional<PlainShape> plain_oscillation(const Dataset& data, const Split& split, const Columns& residual) {
    double best = train_square(residual, split);
    std::optional<PlainShape> out;
    for (std::size_t c = 0; c < residual.size(); ++c) {
        const auto peaks = highest_peaks(data.time_s, seen_by_fit(residual[c], split), data.run, 0.0,
                                         std::numeric_limits<double>::infinity(), 1);
        if (peaks.empty() || peaks[0].false_alarm > significant) continue;
        // The peak's own width is the longest run; a finer search within it.
        double period = peaks[0].period_s, longest = 0.0;
        for (const double t : data.time_s) longest = std::max(longest, t);
        double step = 0.25 * period * period / longest;
        for (int round = 0; round < 12; ++round) {
            double here = train_square(without_sine(data, split, residual, period), split);
            for (const double p : {period - step, period + step}) {
                if (p <= 0.0) continue;
                const double there = train_square(without_sine(data, split, residual, p), split);
                if (there < here) {
                    here = there;
                    period = p;
                }
            }
            step *= 0.6;
        }
        Columns left = without_sine(data, split, residual, period);
        const double square = train_square(left, split);
        if (square >= best) continue;
        best = square;
        double amplitude = 0.0;
        for (std::size_t k = 0; k < left.size(); ++k) {
            double sum = 0.0, rows = 0.0;
            for (std::size_t i = 0; i < left[k].size(); ++i)
                if (!std::isnan(left[k][i])) {
                    sum += (residual[k][i] - left[k][i]) * (residual[k][i] - left[k][i]);
                    rows += 1.0;
                }
            amplitude = std::max(amplitude, rows > 0.0 ? std::sqrt(2.0 * sum / rows) : 0.0);
        }
        // Which column it moves most is said by the one whose peak found it.
        const std::string& name = data.of_role(ColumnRole::measured)[c]->name;
        const std::string unit = unit_of(*data.of_role(ColumnRole::measured)[c]);
        out = PlainShape{
            {"oscillation", name, period, amplitude,
             "period " + plain_number(period, 3) + " s, " + plain_number(amplitude, 3) + unit + " in " + name},
            std::move(left)};
    }
    return out;
}

std::optional<PlainShape> plain_step(const Dataset& data, const Split& split, const Columns& residual,
                                     const LossScale& scale) {
    // Of each run: the moment after which the means, of errors softened to the scale, differ most from those before.
    double best_gain = 0.0;
    std::size_t best_from = 0, best_end = 0;
    std::size_t begin = 0;
    while (begin < data.rows()) {
        std::size_t end = begin;
        while (end < data.rows() && data.run[end] == data.run[begin]) ++end;
        const std::size_t n = end - begin;
        std::vector<double> gain(n, 0.0);
        for (std::size_t c = 0; c < residual.size(); ++c) {
            const double most = 3.0 * scale.of_column[c];
            std::vector<double> sum(n + 1, 0.0), count(n + 1, 0.0);
            for (std::size_t k = 0; k < n; ++k) {
                const double v = residual[c][begin + k];
                const bool use = split.held_out[begin + k] == 0 && !std::isnan(v);
                sum[k + 1] = sum[k] + (use ? std::clamp(v, -most, most) / scale.of_column[c] : 0.0);
                count[k + 1] = count[k] + (use ? 1.0 : 0.0);
            }
            for (std::size_t k = 1; k < n; ++k) {
                const double a = count[k], b = count[n] - count[k];
                if (a < 5.0 || b < 5.0) continue;
                const double d = sum[k] / a - (sum[n] - sum[k]) / b;
                gain[k] += d * d * a * b / (a + b);
            }
        }
        for (std::size_t k = 1; k < n; ++k)
            if (gain[k] > best_gain) {
                best_gain = gain[k];
                best_from = begin + k;
                best_end = end;
            }
        begin = end;
    }
    if (best_gain <= 0.0) return std::nullopt;
    PlainShape out;
    out.residual = residual;
    double largest = 0.0;
    std::size_t widest = 0;
    for (std::size_t c = 0; c < residual.size(); ++c) {
        std::vector<double> before, after;
        for (std::size_t i = 0; i < best_end; ++i) {
            if (data.run[i] != data.run[best_from] || split.held_out[i] != 0 || std::isnan(residual[c][i])) continue;
            (i < best_from ? before : after).push_back(residual[c][i]);
        }
        const auto middle = [](std::vector<double>& v) {
            const auto it = v.begin() + static_cast<std::ptrdiff_t>(v.size() / 2);
            std::nth_element(v.begin(), it, v.end());
            return *it;
        };
        // Both levels, since the base model may have split the difference between them.
        const double low = middle(before), high = middle(after);
        for (std::size_t i = 0; i < best_end; ++i)
            if (data.run[i] == data.run[best_from]) out.residual[c][i] -= i < best_from ? low : high;
        if (std::fabs(high - low) > std::fabs(largest)) {
            largest = high - low;
            widest = c;
        }
    }
    const DataColumn& column = *data.of_role(ColumnRole::measured)[widest];
    out.says = {"step", column.name, 0.0, std::fabs(largest),
                "a step of " + plain_number(largest, 3) + unit_of(column) + " in " + column.name + " at " +
                    plain_number(data.time_s[best_from], 4) + " s of run " +
                    data.run_names[static_cast<std::size_t>(data.run[best_from])]};
    return out;
}

std::vector<Structure> describe_structure(const Dataset& data, const Split& split, const Columns& residual,
                                          const LossScale& scale, std::uint64_t seed) {
    struct Found {
        Structure says;
        double gain;
    };
    std::vector<Found> found;
    const double before = mean_cost(residual, split, 1, scale);
    const auto measured = data.of_role(ColumnRole::measured);
    constexpr double telling = 0.03;  // of the held-out cost
    const auto consider = [&](const Structure& says, const Columns& after, double tries) {
        const double gain = 1.0 - mean_cost(after, split, 1, scale) / before;
        if (gain < telling || tries * gain_by_chance(residual, after, split, scale, seed) > significant) return;
        found.push_back({says, gain});
    };
    if (before > 0.0) {
        if (const auto sine = plain_oscillation(data, split, residual)) consider(sine->says, sine->residual, 1.0);
        if (const auto step = plain_step(data, split, residual, scale)) consider(step->says, step->residual, 1.0);
        const std::vector<Regressor> all = regressors(data);
        for (const Regressor& by : all) {
            Columns after;
            double largest = 0.0;
            std::size_t widest = 0;
            for (std::size_t c = 0; c < residual.size(); ++c) {
                after.push_back(without_bins(residual[c], by, split));
                std::vector<double> part(residual[c].size());
                for (std::size_t i = 0; i < part.size(); ++i) part[i] = residual[c][i] - after[c][i];
                const double size = rms(part);
                if (size > largest) {
                    largest = size;
                    widest = c;
                }
            }
            const std::string unit = unit_of(*measured[widest]);
            const bool runs = by.name == "run";
            consider({runs ? "offsets" : "dependence", by.name, 0.0, largest,
                      (runs ? "steps at run changes, " : "goes with " + by.name + ", ") + plain_number(largest, 3) +
                          unit + " root mean square in " + measured[widest]->name},
                     after, static_cast<double>(all.size()));
        }
    }
    std::sort(found.begin(), found.end(), [](const Found& a, const Found& b) { return a.gain > b.gain; });
    constexpr std::size_t most = 8;
    if (found.size() > most) found.resize(most);
    std::vector<Structure> out;
    for (Found& f : found) {
        f.says.text += " (" + plain_number(100.0 * f.gain, 2) + " % of the held-out error)";
        out.push_back(std::move(f.says));
    }
    for (std::size_t c = 0; c < residual.size(); ++c) {
        const double part = outlier_part(residual[c]);
        if (part > 0.005)
            out.push_back({"outliers", measured[c]->name, 0.0, part,
                           plain_number(100.0 * part, 2) + " % outliers in " + measured[c]->name});
    }
    for (std::size_t c = 0; c < residual.size(); ++c) {
        const double memory = lag_one_autocorrelation(residual[c], data.run);
        if (memory > 0.2)
            out.push_back({"correlation", measured[c]->name, 0.0, memory,
                           "neighbouring rows of " + measured[c]->name + " are alike (correlation " +
                               plain_number(memory, 2) + ")"});
    }
    return out;
}

std::optional<EmpiricalModel> fit_empirical(const Dataset& data, const Split& split, const Columns& residual,
                                            const LossScale& scale, std::uint64_t seed, std::size_t most) {
    std::vector<Regressor> all = regressors(data);
    std::erase_if(all, [](const Regressor& r) { return r.groups; });
    const std::size_t plain = all.size();
    for (std::size_t k = 0; k < plain; ++k) {
        Regressor square{all[k].name + " squared", all[k].values, false};
        for (double& v : square.values) v *= v;
        all.push_back(std::move(square));
    }
    if (const auto sine = plain_oscillation(data, split, residual)) {
        const std::string period = plain_number(sine->says.period_s, 5) + " s";
        Regressor c{"cosine of " + period, {}, false}, s{"sine of " + period, {}, false};
        for (const double t : data.time_s) {
            c.values.push_back(std::cos(2.0 * units::pi * t / sine->says.period_s));
            s.values.push_back(std::sin(2.0 * units::pi * t / sine->says.period_s));
        }
        all.push_back(std::move(c));
        all.push_back(std::move(s));
    }
    for (Regressor& r : all)
        for (double& v : r.values)
            if (std::isnan(v)) v = 0.0;
    EmpiricalModel out;
    const auto measured = data.of_role(ColumnRole::measured);
    Columns left = residual;
    for (std::size_t c = 0; c < residual.size(); ++c) {
        std::vector<std::size_t> taken;
        Eigen::VectorXd numbers;
        while (taken.size() < most) {
            std::optional<std::size_t> best;
            Columns best_left = left;
            Eigen::VectorXd best_numbers;
            double least = mean_cost(left, split, 0, scale);
            for (std::size_t k = 0; k < all.size(); ++k) {
                if (std::find(taken.begin(), taken.end(), k) != taken.end()) continue;
                Basis basis(static_cast<Eigen::Index>(data.rows()), static_cast<Eigen::Index>(taken.size() + 2));
                for (std::size_t i = 0; i < data.rows(); ++i) {
                    const auto row = static_cast<Eigen::Index>(i);
                    basis(row, 0) = 1.0;
                    for (std::size_t j = 0; j < taken.size(); ++j)
                        basis(row, static_cast<Eigen::Index>(j + 1)) = all[taken[j]].values[i];
                    basis(row, static_cast<Eigen::Index>(taken.size() + 1)) = all[k].values[i];
                }
                Columns trial = left;
                trial[c] = residual[c];
                const Eigen::VectorXd x = solve_linear(basis, residual[c], split);
                subtract(basis, x, trial[c]);
                const double cost = mean_cost(trial, split, 0, scale);
                if (cost >= least) continue;
                least = cost;
                best = k;
                best_left = std::move(trial);
                best_numbers = x;
            }
            const double tries = static_cast<double>(all.size() * residual.size());
            if (!best || tries * gain_by_chance(left, best_left, split, scale, seed) > significant) break;
            if (mean_cost(best_left, split, 1, scale) > 0.98 * mean_cost(left, split, 1, scale)) break;
            taken.push_back(*best);
            left = std::move(best_left);
            numbers = best_numbers;
        }
        for (std::size_t j = 0; j < taken.size(); ++j)
            out.terms.push_back({measured[c]->name, all[taken[j]].name, numbers[static_cast<Eigen::Index>(j + 1)]});
    }
    if (out.terms.empty()) return std::nullopt;
    out.held_out_rms = rms_of(left, split, 1);
    return out;
}

}  // namespace cathlab
