#include "explain/tracer.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <sstream>

#include "core/errors.h"
#include "core/random.h"
#include "explain/base_model.h"
#include "explain/rig.h"
#include "optimise/local.h"
#include "optimise/swarm.h"

namespace cathlab {
namespace {

using Columns = std::vector<std::vector<double>>;

constexpr double significant = 0.01;
constexpr double least_gain = 0.02;
constexpr double floor_factor = 1.15;  // a residual this near to the noise is noise

void add(Columns& to, const Columns& more) {
    for (std::size_t c = 0; c < to.size(); ++c)
        for (std::size_t i = 0; i < to[c].size(); ++i) to[c][i] += more[c][i];
}

/// Root mean square a column, over the rows of one part.
double rms_of(const Columns& residual, const std::vector<std::uint8_t>& held_out, std::uint8_t part) {
    double sum = 0.0;
    for (const auto& column : residual) {
        const double r = rms(column, held_out, part);
        if (!std::isnan(r)) sum += r * r;
    }
    return std::sqrt(sum / static_cast<double>(residual.size()));
}

/// How often chance alone would lower the squared error of the held-out blocks by as much (signs of the blocks
/// flipped).
double permutation_p(const Columns& before, const Columns& after, const Split& split, std::uint64_t seed) {
    constexpr int draws = 4000;
    std::vector<double> gain(static_cast<std::size_t>(split.blocks), 0.0);
    for (std::size_t c = 0; c < before.size(); ++c)
        for (std::size_t i = 0; i < before[c].size(); ++i)
            if (split.held_out[i] != 0 && !std::isnan(before[c][i]))
                gain[static_cast<std::size_t>(split.block[i])] +=
                    before[c][i] * before[c][i] - after[c][i] * after[c][i];
    double observed = 0.0;
    for (const double g : gain) observed += g;
    int as_large = 0;
    for (int draw = 0; draw < draws; ++draw) {
        double sum = 0.0;
        for (std::size_t b = 0; b < gain.size(); ++b) {
            const bool flip = random_uniform(seed, RandomStream::sampling, static_cast<std::uint64_t>(draw), b) < 0.5;
            sum += flip ? -gain[b] : gain[b];
        }
        as_large += sum >= observed ? 1 : 0;
    }
    return (1.0 + as_large) / (1.0 + draws);
}

struct Fit {
    std::vector<double> values;  // all parameters of the effect
    Columns contribution;
    bool on_bound = false;
    std::string bound_name;
};

/// One effect fitted beside the base model and what was already found.
class Fitter {
public:
    Fitter(const EffectInfo& effect, const Dataset& data, const Split& split, const BaseModel& base,
           const Columns& found)
        : effect_(effect), data_(data), split_(split), base_(base), found_(found) {
        const std::vector<bool> free = identifiable(effect, data);
        for (std::size_t k = 0; k < free.size(); ++k) {
            const Parameter& p = effect.parameters[k];
            values_.push_back(p.default_value);
            if (!free[k]) continue;
            free_.push_back(k);
            problem_.bounds.push_back({p.minimum, p.maximum, std::string(p.key)});
            start_.push_back(p.default_value);
        }
        problem_.objective = [this](std::span<const double> x) { return objective(x); };
    }

    bool nothing_to_fit() const { return free_.empty(); }

    Fit run(const ExplainOptions& options) {
        SwarmOptions swarm;
        swarm.particles = 32;
        swarm.generations = 25;
        swarm.omega = 0.6;
        swarm.eta1 = swarm.eta2 = 1.2;
        swarm.seed = options.seed;
        swarm.threads = options.threads;
        problem_.start = start_;
        Result best = minimise_swarm(problem_, swarm);
        std::vector<std::vector<double>> starts{best.best};
        for (const auto& s : spectral_starts()) starts.push_back(s);
        for (const auto& s : starts) {
            problem_.start = s;
            LocalOptions local;
            local.method = LocalMethod::sbplx;
            local.max_evaluations = 400;
            local.first_step = 0.02;
            local.x_tolerance = 1e-7;
            const Result result = minimise_local(problem_, local);
            if (result.value < best.value) best = result;
        }
        return describe(best.best);
    }

private:
    std::vector<double> all_values(std::span<const double> x) const {
        std::vector<double> values = values_;
        for (std::size_t k = 0; k < free_.size(); ++k) values[free_[k]] = x[k];
        return values;
    }

    double objective(std::span<const double> x) const {
        Columns sum = effect_on_rig(effect_, all_values(x), data_);
        add(sum, found_);
        const double error = rms_of(base_.residual(sum), split_.held_out, 0);
        double ridge = 0.0;
        for (std::size_t k = 0; k < free_.size(); ++k) {
            const Bound& b = problem_.bounds[k];
            const double off = (x[k] - start_[k]) / (b.upper - b.lower);
            ridge += off * off / static_cast<double>(free_.size());
        }
        return error * error * (1.0 + 1e-4 * ridge);
    }

    /// Parameters in seconds begin at the periods that the residual shows, pure numbers from 0 to 1 (phases) at four
    /// places.
    std::vector<std::vector<double>> spectral_starts() const {
        std::vector<std::vector<double>> out;
        std::optional<std::size_t> period, phase;
        for (std::size_t k = 0; k < free_.size(); ++k) {
            const Parameter& p = effect_.parameters[free_[k]];
            if (p.unit == "s" && !period) period = k;
            if (p.key.find("phase") != std::string_view::npos && !phase) phase = k;
        }
        if (!period) return out;
        for (const auto& column : base_.residual(found_)) {
            const SpectrumPeak peak = highest_peak(data_.time_s, column, data_.run);
            for (const double factor : {1.0, 2.0})
                for (const double place : {0.1, 0.35, 0.6, 0.85}) {
                    std::vector<double> s = start_;
                    const Bound& b = problem_.bounds[*period];
                    s[*period] = std::clamp(peak.period_s * factor, b.lower, b.upper);
                    if (phase) s[*phase] = place;
                    out.push_back(s);
                    if (!phase) break;
                }
        }
        return out;
    }

    Fit describe(const std::vector<double>& x) const {
        Fit fit;
        fit.values = all_values(x);
        fit.contribution = effect_on_rig(effect_, fit.values, data_);
        for (std::size_t k = 0; k < free_.size(); ++k) {
            const Bound& b = problem_.bounds[k];
            const double near = 1e-3 * (b.upper - b.lower);
            // Directions and phases are pure numbers whose ends are no limits of strength.
            if (effect_.parameters[free_[k]].unit != "1" && (x[k] - b.lower < near || b.upper - x[k] < near)) {
                fit.on_bound = true;
                fit.bound_name = b.name;
            }
        }
        return fit;
    }

    const EffectInfo& effect_;
    const Dataset& data_;
    const Split& split_;
    const BaseModel& base_;
    const Columns& found_;
    std::vector<double> values_, start_;
    std::vector<std::size_t> free_;
    Problem problem_;
};

std::string rounded(double value) {
    std::ostringstream out;
    out.precision(3);
    out << value;
    return out.str();
}

std::vector<Structure> describe_left_over(const Dataset& data, const BaseModel& base, const Columns& residual) {
    std::vector<Structure> out;
    for (std::size_t c = 0; c < residual.size(); ++c) {
        const DataColumn& column = *base.measured()[c];
        const std::string unit = column.unit.empty() ? "" : " " + column.unit;
        const SpectrumPeak peak = highest_peak(data.time_s, residual[c], data.run);
        if (peak.false_alarm < significant && peak.explained > 0.05)
            out.push_back({"oscillation", column.name, peak.period_s, peak.amplitude,
                           "period " + rounded(peak.period_s) + " s, " + rounded(peak.amplitude) + unit + " in " +
                               column.quantity});
        const double part = outlier_part(residual[c]);
        if (part > 0.005)
            out.push_back(
                {"outliers", column.name, 0.0, part, rounded(100.0 * part) + " % outliers in " + column.quantity});
        const double memory = lag_one_autocorrelation(residual[c], data.run);
        if (memory > 0.2)
            out.push_back(
                {"correlation", column.name, 0.0, memory,
                 "neighbouring rows of " + column.quantity + " are alike (correlation " + rounded(memory) + ")"});
    }
    return out;
}

std::string overlay_text(const std::vector<FittedEffect>& effects) {
    std::ostringstream out;
    for (const FittedEffect& effect : effects) {
        out << "[effects." << effect.name << "]\nenabled = true\n";
        for (const auto& [key, value] : effect.parameters) {
            std::ostringstream number;
            number.precision(9);
            number << value;
            const std::string text = number.str();
            out << key << " = " << text << (text.find_first_of(".e") == std::string::npos ? ".0" : "") << "\n";
        }
    }
    return out.str();
}

double floor_of(const Dataset& data, const Columns& residual) {
    if (data.sensor_noise > 0.0) return data.sensor_noise;
    double sum = 0.0;
    for (const auto& column : residual) {
        const double noise = noise_by_differences(column, data.run);
        sum += std::isnan(noise) ? 0.0 : noise * noise;
    }
    return std::sqrt(sum / static_cast<double>(residual.size()));
}

}  // namespace

std::string verdict_text(Verdict verdict) {
    switch (verdict) {
        case Verdict::nothing_missing: return "nothing missing";
        case Verdict::explained: return "explained";
        case Verdict::partly_explained: return "partly explained";
        case Verdict::unexplained: break;
    }
    return "unexplained";
}

Explanation explain(const Dataset& data, const ExplainOptions& options) {
    const Split split = split_rows(data);
    const BaseModel base(data, split);
    Explanation out;
    out.base_parameters = base.parameters();
    Columns found(base.measured().size(), std::vector<double>(data.rows(), 0.0));
    Columns residual = base.residual(found);
    out.noise_floor = floor_of(data, residual);
    out.train_before = rms_of(residual, split.held_out, 0);
    out.held_out_before = rms_of(residual, split.held_out, 1);

    std::vector<const EffectInfo*> candidates;
    for (const EffectInfo& effect : effect_table()) {
        const auto& kinds = effect.applies_to;
        if (effect.for_tests || std::find(kinds.begin(), kinds.end(), data.kind) == kinds.end()) continue;
        const auto& declared = data.declared_effects;
        const std::string name(effect.name);
        if (std::find(declared.begin(), declared.end(), name) != declared.end()) {
            out.cannot.push_back("'" + name + "' is declared, but the base model of kind '" + data.kind +
                                 "' does not hold declared effects yet");
            continue;
        }
        if (const auto why = why_not_tried(effect, data)) {
            out.candidates.push_back({name, std::numeric_limits<double>::quiet_NaN(), 1.0, *why});
            out.cannot.push_back("'" + name + "' could not be tried: " + *why);
            continue;
        }
        candidates.push_back(&effect);
    }

    const auto noise_only = [&] { return rms_of(residual, split.held_out, 1) <= floor_factor * out.noise_floor; };
    const auto tries = static_cast<double>(candidates.size());
    for (int round = 0; round < options.max_effects && !candidates.empty(); ++round) {
        const double before = rms_of(residual, split.held_out, 1);
        std::optional<std::size_t> best;
        Fit best_fit;
        double best_rms = before, best_p = 1.0;
        for (std::size_t k = 0; k < candidates.size(); ++k) {
            const EffectInfo& effect = *candidates[k];
            if (options.on_progress &&
                !options.on_progress((round + static_cast<double>(k) / tries) / std::max(1, options.max_effects)))
                throw UserError("stopped; nothing was written");
            Candidate candidate{std::string(effect.name), before, 1.0, ""};
            Fitter fitter(effect, data, split, base, found);
            if (fitter.nothing_to_fit()) {
                candidate.refused_because = "none of its parameters changes anything here";
                out.candidates.push_back(candidate);
                continue;
            }
            const Fit fit = fitter.run(options);
            Columns sum = found;
            add(sum, fit.contribution);
            const Columns after = base.residual(sum);
            candidate.held_out_rms = rms_of(after, split.held_out, 1);
            candidate.p_value = std::min(1.0, tries * permutation_p(residual, after, split, options.seed));
            if (candidate.p_value >= significant)
                candidate.refused_because = "the held-out error does not fall by more than chance allows";
            else if (candidate.held_out_rms > (1.0 - least_gain) * before)
                candidate.refused_because = "the held-out error falls by less than 2 %";
            else if (fit.on_bound)
                candidate.refused_because = "its '" + fit.bound_name + "' ends on a bound of its range";
            else if (candidate.held_out_rms < best_rms) {
                best = k;
                best_fit = fit;
                best_rms = candidate.held_out_rms;
                best_p = candidate.p_value;
            }
            out.candidates.push_back(candidate);
        }
        if (!best) break;
        const EffectInfo& taken = *candidates[*best];
        FittedEffect effect{std::string(taken.name), {}, best_p, before, best_rms};
        for (std::size_t k = 0; k < taken.parameters.size(); ++k)
            effect.parameters.emplace_back(std::string(taken.parameters[k].key), best_fit.values[k]);
        out.effects.push_back(std::move(effect));
        add(found, best_fit.contribution);
        residual = base.residual(found);
        candidates.erase(candidates.begin() + static_cast<std::ptrdiff_t>(*best));
    }

    out.train_after = rms_of(residual, split.held_out, 0);
    out.held_out_after = rms_of(residual, split.held_out, 1);
    out.left_over = describe_left_over(data, base, residual);
    if (data.sensor_noise <= 0.0) out.noise_floor = floor_of(data, residual);
    out.overlay = overlay_text(out.effects);
    if (out.effects.empty())
        out.verdict = noise_only() ? Verdict::nothing_missing : Verdict::unexplained;
    else
        out.verdict = noise_only() ? Verdict::explained : Verdict::partly_explained;
    return out;
}

}  // namespace cathlab
