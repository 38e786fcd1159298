#include "explain/fit.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "explain/residual.h"
#include "optimise/least_squares.h"

namespace cathlab {
namespace {

/// Numbers that may be of any size between a trace and a mountain are searched by their logarithm:
/// q = ln(1 + v / usual).
class Scale {
public:
    explicit Scale(const Parameter& p) : usual_(p.default_value) {
        constexpr double wide = 50.0;
        logarithmic_ = p.minimum >= 0.0 && usual_ > 0.0 && p.maximum > wide * usual_;
    }
    double to(double v) const { return logarithmic_ ? std::log1p(v / usual_) : v; }
    double from(double q) const { return logarithmic_ ? usual_ * std::expm1(q) : q; }

private:
    double usual_;
    bool logarithmic_ = false;
};

/// Other numbers for what only shapes an effect: near each end of the range of one of them, then all spread over their
/// ranges: many ways where a rig is quick and they are more than two.  False where there are no more.
bool reshape(const EffectInfo& effect, const std::vector<bool>& free, int number, bool quick,
             std::vector<double>& values) {
    std::vector<std::size_t> shapes;
    for (std::size_t k = 0; k < effect.parameters.size(); ++k) {
        const Parameter& p = effect.parameters[k];
        if (free[k] && !is_strength(effect, p) && !is_phase(p) && !is_direction(p) && p.key != "period_s")
            shapes.push_back(k);
    }
    const int single = 2 * static_cast<int>(shapes.size());
    const int spread = quick && shapes.size() > 2 ? 12 : 2;  // shapes in which all differ
    if (shapes.empty() || number > single + spread) return false;
    for (std::size_t j = 0; j < shapes.size(); ++j) {
        const Parameter& p = effect.parameters[shapes[j]];
        double place = number % 2 == 1 ? 0.05 : 0.95;
        if (number > single)  // points that fill a box evenly, one after another
            place = std::fmod(number * (0.618 + 0.137 * static_cast<double>(j)), 1.0);
        else if (static_cast<std::size_t>((number - 1) / 2) != j)
            continue;
        const Scale scale(p);
        values[shapes[j]] = scale.from(scale.to(p.minimum) + place * (scale.to(p.maximum) - scale.to(p.minimum)));
    }
    return true;
}

std::vector<double> defaults(const EffectInfo& effect) {
    std::vector<double> out;
    for (const Parameter& p : effect.parameters) out.push_back(p.default_value);
    return out;
}

/// All but their strengths is the same.
bool same_shape(const EffectInfo& effect, const EffectTrial& a, const EffectTrial& b) {
    for (std::size_t k = 0; k < effect.parameters.size(); ++k)
        if (!is_strength(effect, effect.parameters[k]) && a.values[k] != b.values[k]) return false;
    return true;
}

/// A place of the range where the effect certainly acts.
std::vector<double> acting(const EffectInfo& effect) {
    std::vector<double> out = defaults(effect);
    for (std::size_t k = 0; k < out.size(); ++k) {
        const Parameter& p = effect.parameters[k];
        if (is_strength(effect, p) && out[k] == 0.0) out[k] = 0.1 * p.maximum;
    }
    return out;
}

}  // namespace

bool is_strength(const EffectInfo& effect, const Parameter& p) {
    return std::find(effect.strengths.begin(), effect.strengths.end(), p.key) != effect.strengths.end();
}
bool is_phase(const Parameter& p) {
    return p.key == "phase";
}
bool is_direction(const Parameter& p) {
    return p.key.starts_with("direction");
}

const EffectTrial& trial_of(const FittedModel& model, const EffectInfo& effect) {
    return *std::find_if(model.effects.begin(), model.effects.end(),
                         [&](const EffectTrial& trial) { return trial.effect == &effect; });
}

bool is_own(const EffectInfo& effect, const Parameter& p) {
    return is_direction(p) || p.key == "held_until_s" || (p.unit == "mm" && is_strength(effect, p));
}

std::string why_no_effect(const EffectTrial& trial, const std::vector<bool>& free) {
    constexpr double near = 1e-3;
    bool strong = false;
    std::vector<std::vector<double>> all = trial.own;
    if (all.empty()) all.push_back(trial.values);
    for (const std::vector<double>& values : all)
        for (std::size_t k = 0; k < values.size(); ++k) {
            const Parameter& p = trial.effect->parameters[k];
            if (!free[k]) continue;
            const double value = values[k], range = p.maximum - p.minimum;
            const double least = p.default_value > 0.0 ? std::min(near * range, 0.01 * p.default_value) : near * range;
            if (is_strength(*trial.effect, p) && std::fabs(value) > least) strong = true;
            if (is_phase(p) || is_direction(p)) continue;
            // 0 and 1 are ends by meaning (none, all of it), not by the range that somebody chose.
            const auto& ends = trial.effect->meant_ends;
            const bool meant = std::find(ends.begin(), ends.end(), p.key) != ends.end();
            const auto natural = [&](double bound) { return meant || bound == 0.0 || (bound == 1.0 && p.unit == "1"); };
            const Scale scale(p);
            const double place = scale.to(value), from = scale.to(p.minimum), to = scale.to(p.maximum);
            const bool low = place - from < near * (to - from) && !natural(p.minimum);
            const bool high = to - place < near * (to - from) && !natural(p.maximum);
            if (low || high) return "its '" + std::string(p.key) + "' ends on a bound of its range";
        }
    return strong ? "" : "its strength is zero";
}

void Fitter::weigh_by(const FittedModel& model) {
    std::vector<double> least(model.residual.size(), noise_);
    const std::vector<double> own = rig_.own_error();
    for (std::size_t c = 0; c < own.size(); ++c) least[c] = std::hypot(noise_, own[c]);
    scale_ = loss_scale(model.residual, rig_.split(), least);
}

double Fitter::cost_of(const FittedModel& model) const {
    return mean_cost(model.residual, rig_.split(), 0, scale_);
}

double Fitter::misfit(const FittedModel& model) const {
    double sum = 0.0;
    for (std::size_t c = 0; c < model.residual.size(); ++c) {
        double cost = 0.0, rows = 0.0;
        for (std::size_t i = 0; i < model.residual[c].size(); ++i) {
            if (rig_.split().held_out[i] != 0 || std::isnan(model.residual[c][i])) continue;
            cost += scale_.cost(c, model.residual[c][i]);
            rows += 1.0;
        }
        if (rows > 0.0) sum += rows * std::log(std::max(cost / rows, 1e-12));
    }
    return sum;
}

void Fitter::refit(FittedModel& model, int iterations, bool base_too) const {
    refit(model, iterations, base_too, rig_.memory().get());
}

void Fitter::refit(FittedModel& model, int iterations, bool base_too, RigMemory* memory) const {
    const Split& split = rig_.split();
    std::vector<Bound> base = rig_.bounds();
    if (!base_too)
        for (std::size_t k = 0; k < base.size(); ++k) base[k].lower = base[k].upper = model.base[k];
    LeastSquaresProblem problem;
    problem.bounds = base;
    problem.start = model.base;
    std::vector<double> weights(base.size(), 0.0), centres(base.size(), 0.0);
    const double rows = known_rows(model.residual, split, 0);
    for (const EffectTrial& trial : model.effects) {
        const std::vector<bool>& free = free_parameters(*trial.effect);
        for (std::size_t k = 0; k < trial.values.size(); ++k) {
            const Parameter& p = trial.effect->parameters[k];
            const double v = std::clamp(trial.values[k], p.minimum, p.maximum);
            const Scale scale(p);
            Bound bound{scale.to(p.minimum), scale.to(p.maximum), std::string(p.key)};
            if (is_phase(p)) bound = {p.minimum - 1.0, p.maximum + 1.0, bound.name};  // goes round
            const double range = bound.upper - bound.lower;
            if (!free[k] || (!trial.own.empty() && is_own(*trial.effect, p))) bound.lower = bound.upper = scale.to(v);
            problem.bounds.push_back(bound);
            problem.start.push_back(scale.to(v));
            // A trace of ridge towards no effect, and towards the usual value of what only shapes it: numbers that the
            // data cannot tell stay there.
            weights.push_back(free[k] ? 3e-3 * std::sqrt(rows) / range : 0.0);
            centres.push_back(is_strength(*trial.effect, p) ? 0.0 : scale.to(p.default_value));
        }
        for (const std::vector<double>& own : trial.own)
            for (std::size_t k = 0; k < own.size(); ++k) {
                const Parameter& p = trial.effect->parameters[k];
                if (!free[k] || !is_own(*trial.effect, p)) continue;
                const Scale scale(p);
                problem.bounds.push_back({scale.to(p.minimum), scale.to(p.maximum), std::string(p.key)});
                problem.start.push_back(scale.to(std::clamp(own[k], p.minimum, p.maximum)));
                weights.push_back(3e-3 * std::sqrt(rows) / (problem.bounds.back().upper - problem.bounds.back().lower));
                centres.push_back(is_strength(*trial.effect, p) ? 0.0 : scale.to(p.default_value));
            }
        for (std::size_t run = 0; run < trial.phase_of_run.size(); ++run) {
            problem.bounds.push_back({run == 0 ? 0.0 : -1.0, run == 0 ? 0.0 : 1.0, "phase of run"});
            problem.start.push_back(trial.phase_of_run[run]);
            weights.push_back(0.0);
            centres.push_back(0.0);
        }
    }
    if (problem.bounds.empty()) {
        model.residual = rig_.residual_near(model.base, model.effects, memory);
        model.train_cost = cost_of(model);
        return;
    }
    const auto unpack = [&](std::span<const double> x, FittedModel& to) {
        std::size_t at = base.size();
        to.base.assign(x.begin(), x.begin() + static_cast<std::ptrdiff_t>(at));
        for (EffectTrial& trial : to.effects) {
            for (std::size_t k = 0; k < trial.values.size(); ++k) {
                const Parameter& p = trial.effect->parameters[k];
                trial.values[k] = is_phase(p) ? x[at] : std::clamp(Scale(p).from(x[at]), p.minimum, p.maximum);
                ++at;
            }
            const std::vector<bool>& free = free_parameters(*trial.effect);
            for (std::vector<double>& own : trial.own)
                for (std::size_t k = 0; k < own.size(); ++k) {
                    const Parameter& p = trial.effect->parameters[k];
                    own[k] = free[k] && is_own(*trial.effect, p)
                                 ? std::clamp(Scale(p).from(x[at++]), p.minimum, p.maximum)
                                 : trial.values[k];
                }
            for (double& v : trial.phase_of_run) v = x[at++];
        }
    };
    problem.residuals = static_cast<std::size_t>(rows) + weights.size();
    problem.residual = [&](std::span<const double> x, std::span<double> out) {
        FittedModel trial;
        trial.effects = model.effects;
        unpack(x, trial);
        const Columns left = rig_.residual_near(trial.base, trial.effects, memory);
        std::size_t at = 0;
        for (std::size_t c = 0; c < left.size(); ++c)
            for (std::size_t i = 0; i < left[c].size(); ++i)
                if (split.held_out[i] == 0 && !std::isnan(model.residual[c][i]))
                    out[at++] = scale_.softened(c, left[c][i]);
        for (std::size_t k = 0; k < weights.size(); ++k) out[at++] = weights[k] * (x[k] - centres[k]);
        return true;
    };
    LeastSquaresOptions options;
    options.max_iterations = iterations;
    options.value_tolerance = rig_.slow() ? 1e-3 : 1e-5;
    if (rig_.slow()) options.step = 3e-3;         // a wall at rest is known to a tolerance
    if (memory == nullptr) options.crew = crew_;  // a memory serves one model after another
    const Result found = minimise_squares(problem, options);
    unpack(found.best, model);
    for (EffectTrial& fitted : model.effects)
        for (std::size_t k = 0; k < fitted.values.size(); ++k)
            if (is_phase(fitted.effect->parameters[k])) {
                fitted.values[k] -= std::floor(fitted.values[k]);
                for (std::vector<double>& own : fitted.own) own[k] = fitted.values[k];
            }
    model.residual = rig_.residual_near(model.base, model.effects, memory);
    model.train_cost = cost_of(model);
}

bool Fitter::learn(const EffectInfo& effect) {
    const std::vector<double> base = rig_.start();
    const std::size_t count = effect.parameters.size();
    const auto residual = [&](const std::vector<double>& values) {
        EffectTrial trial{&effect, values};
        // What all recordings have alike, the beat of a heart may take up.
        if (may_differ(effect)) {
            trial.own.assign(rig_.data().run_names.size(), acting(effect));
            trial.own.back() = values;
        }
        return rig_.residual(base, std::span(&trial, 1));
    };
    std::vector<bool> may(count), out(count, false);
    for (std::size_t k = 0; k < count; ++k) may[k] = !rig_.takes_up(effect, effect.parameters[k].key);
    if (rig_.slow()) {
        free_[&effect] = may;
        return std::find(may.begin(), may.end(), true) != may.end();
    }
    for (int shape = 0;; ++shape) {
        std::vector<double> usual = acting(effect);
        if (shape > 0 && (!reshape(effect, may, shape, false, usual) || out == may)) break;
        const Columns there = residual(usual);
        for (std::size_t k = 0; k < count; ++k) {
            const Parameter& p = effect.parameters[k];
            bool matters = out[k];
            for (const double part : {0.13, 0.71}) {
                if (!may[k] || matters) break;
                std::vector<double> other = usual;
                other[k] = usual[k] + part * ((part < 0.5 ? p.minimum : p.maximum) - usual[k]);
                const Columns here = residual(other);
                for (std::size_t c = 0; c < here.size() && !matters; ++c)
                    for (std::size_t i = 0; i < here[c].size() && !matters; ++i)
                        matters = std::fabs(here[c][i] - there[c][i]) > 1e-7;
            }
            out[k] = matters;
        }
        // An effect that acts as it usually does is known by that.
        if (std::find(out.begin(), out.end(), true) != out.end() && rig_.bounds().empty() && !may_differ(effect)) break;
    }
    const bool any = std::find(out.begin(), out.end(), true) != out.end();
    free_[&effect] = std::move(out);
    return any;
}

bool Fitter::quick() const {
    return rig_.bounds().size() <= few_numbers && !rig_.bounds().empty() && !rig_.slow();
}

std::vector<std::vector<double>> Fitter::starts(const FittedModel& from, const EffectInfo& effect) const {
    const std::vector<bool>& free = free_parameters(effect);
    std::size_t period = effect.parameters.size();
    for (std::size_t k = 0; k < effect.parameters.size(); ++k)
        if (free[k] && effect.parameters[k].key == "period_s") period = k;
    const bool swings = period < effect.parameters.size() && phase_place(effect) < effect.parameters.size();
    std::vector<std::vector<double>> levels;
    for (const double level : {0.01, 0.05, 0.2}) {
        for (const double sign : {1.0, -1.0}) {
            std::vector<double> values = defaults(effect);
            bool turned = false;
            for (std::size_t k = 0; k < values.size(); ++k) {
                const Parameter& p = effect.parameters[k];
                if (!free[k] || !is_strength(effect, p)) continue;
                turned = turned || p.minimum < 0.0;
                const Scale scale(p);
                values[k] = std::clamp(scale.from((p.minimum < 0.0 ? sign : 1.0) * level * scale.to(p.maximum)),
                                       p.minimum, p.maximum);
            }
            // Half a turn of the phase is the other sign.
            if (sign > 0.0 || (turned && !swings)) levels.push_back(values);
        }
    }
    // What only shapes it may matter as much as its strength.  Where a model takes seconds other shapes are looked at
    // in one strength alone.
    if (period == effect.parameters.size()) {
        const std::size_t plain = levels.size();
        for (int other = 1;; ++other) {
            std::vector<double> any;
            for (std::size_t level = rig_.slow() ? plain / 2 : 0; level < (rig_.slow() ? plain / 2 + 1 : plain);
                 ++level) {
                std::vector<double> values = levels[level];
                if (!reshape(effect, free, other, quick(), values)) break;
                any = values;
                levels.push_back(std::move(values));
            }
            if (any.empty()) break;
        }
    }
    const std::size_t ways = levels.size();
    for (std::size_t way = 0; way < ways; ++way) {
        std::vector<double> back = levels[way];
        for (std::size_t k = 0; k < back.size(); ++k)
            if (free[k] && is_direction(effect.parameters[k])) back[k] = -back[k];
        if (back != levels[way]) levels.push_back(std::move(back));
    }
    if (period == effect.parameters.size()) return levels;
    // Periods that the residual shows, and all over the range: a rate that varies shows beside the beat's own lines.
    const Dataset& data = rig_.data();
    std::vector<double> periods;
    const Parameter& range = effect.parameters[period];
    double longest = 0.0;
    for (const double t : data.time_s) longest = std::max(longest, t);
    double period_s = range.minimum;
    while (period_s <= std::min(range.maximum, 2.0 * longest)) {
        periods.push_back(period_s);
        period_s *= 1.5;
    }
    for (const auto& column : from.residual) {
        std::vector<double> seen = column;
        for (std::size_t i = 0; i < seen.size(); ++i)
            if (rig_.split().held_out[i] != 0) seen[i] = std::numeric_limits<double>::quiet_NaN();
        for (const SpectrumPeak& peak : highest_peaks(data.time_s, seen, data.run, range.minimum, range.maximum, 3))
            periods.push_back(peak.period_s);
    }
    std::vector<std::vector<double>> out;
    for (const double p : periods)
        for (std::vector<double> values : levels) {
            values[period] = std::clamp(p, range.minimum, range.maximum);
            out.push_back(values);
        }
    return out;
}

FittedModel Fitter::beside(const FittedModel& from, const EffectTrial& trial) const {
    FittedModel model;
    model.base = from.base;
    model.effects = from.effects;
    // In the manifest's order, in which a step asks them.
    const auto place = std::find_if(model.effects.begin(), model.effects.end(),
                                    [&](const EffectTrial& known) { return known.effect > trial.effect; });
    model.effects.insert(place, trial);
    return model;
}

FittedModel Fitter::with(const FittedModel& from, const EffectInfo& effect) const {
    // Base numbers that are few go along from the beginning; where they are many, the effect looks where to go first.
    const bool base_too = rig_.bounds().size() <= few_numbers;
    const bool shaped = quick();
    const std::size_t searched = rig_.slow() ? 1 : shaped ? 12 : 2;  // of each way
    std::vector<FittedModel> tried[2];
    const std::vector<double> usual = defaults(effect);
    const auto better = [](const FittedModel& a, const FittedModel& b) { return a.train_cost < b.train_cost; };
    const std::unique_ptr<RigMemory> memory = rig_.memory();
    const std::vector<std::vector<double>> all = starts(from, effect);
    std::vector<FittedModel> begun(all.size());
    (memory ? Crew() : crew_).each(all.size(), [&](std::size_t k) {
        begun[k] = beside(from, turned(from, {&effect, all[k]}));
        begun[k].residual = rig_.residual_near(begun[k].base, begun[k].effects, memory.get());
        begun[k].train_cost = cost_of(begun[k]);
    });
    for (FittedModel& model : begun) {
        const std::vector<double>& values = trial_of(model, effect).values;
        bool back = false;
        for (std::size_t k = 0; k < values.size(); ++k)
            back = back || (is_direction(effect.parameters[k]) && values[k] != usual[k]);
        std::vector<FittedModel>& best = tried[back ? 1 : 0];
        // The base numbers have not moved yet, which favours shapes that change little: of each shape one is searched.
        const auto alike = std::find_if(best.begin(), best.end(), [&](const FittedModel& other) {
            return shaped && same_shape(effect, trial_of(model, effect), trial_of(other, effect));
        });
        if (alike == best.end())
            best.push_back(std::move(model));
        else if (better(model, *alike))
            *alike = std::move(model);
        std::sort(best.begin(), best.end(), better);
        if (!shaped && best.size() > searched) best.pop_back();
    }
    for (std::vector<FittedModel>& way : tried)
        if (way.size() > searched) way.resize(searched);
    FittedModel best, own;
    const auto take = [&](FittedModel& most, FittedModel& model) {
        const bool first = most.effects.empty();
        const bool closer_to = first || (rig_.slow() ? better(model, most) : misfit(model) < misfit(most));
        if (closer_to) most = std::move(model);
    };
    if (may_differ(effect)) {
        std::vector<FittedModel> others = tried[0];
        others.insert(others.end(), tried[1].begin(), tried[1].end());
        crew_.each(others.size(), [&](std::size_t k) { others[k] = each_run_its_own(std::move(others[k]), effect); });
        for (FittedModel& model : others) take(own, model);
    }
    for (std::vector<FittedModel>& way : tried) {
        int iterations = rig_.slow() ? 6 : 10;
        if (shaped) {  // a few steps for all of them, more for the better half
            crew_.each(way.size(), [&](std::size_t k) { refit(way[k], 4); });
            std::sort(way.begin(), way.end(), better);
            way.resize((way.size() + 1) / 2);
            iterations = 8;
        }
        (memory ? Crew() : crew_).each(way.size(), [&](std::size_t k) {
            refit(way[k], iterations, base_too, memory.get());
        });
        for (FittedModel& model : way) take(best, model);
    }
    const auto finish = [&](FittedModel& model, int iterations) {
        closer(model).refit(model, iterations);
        model.train_cost = cost_of(model);
    };
    if (!rig_.slow()) finish(best, rig_.bounds().empty() ? 30 : 15);
    std::vector<FittedModel> valleys = in_other_valleys(from, effect);
    crew_.each(valleys.size(), [&](std::size_t k) { finish(valleys[k], 15); });
    for (FittedModel& model : valleys) take(best, model);
    if (own.effects.empty()) return best;
    // Numbers of their own have to pay for themselves [schwarz1978].
    settle_runs(own, effect);
    finish(own, 15);
    centre(own, effect);
    const double rows = known_rows(own.residual, rig_.split(), 0);
    double numbers = 0.0;
    for (std::size_t k = 0; k < effect.parameters.size(); ++k)
        numbers += free_parameters(effect)[k] && is_own(effect, effect.parameters[k]) ? 1.0 : 0.0;
    numbers *= static_cast<double>(rig_.data().run_names.size() - 1);
    return misfit(best) - misfit(own) > numbers * std::log(rows) ? own : best;
}

FittedModel Fitter::without(const FittedModel& from, std::size_t k) const {
    FittedModel model = from;
    model.effects.erase(model.effects.begin() + static_cast<std::ptrdiff_t>(k));
    model.residual = rig_.residual(model.base, model.effects);
    refit(model, rig_.slow() ? 4 : 25);
    return model;
}

}  // namespace cathlab
