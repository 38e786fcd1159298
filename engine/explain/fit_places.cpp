// Recordings that were each taken at another place: an effect with numbers of their own.
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/random.h"
#include "explain/fit.h"

namespace cathlab {
namespace {

/// The phase at which a recording begins: each has its own, or all have the first one's.
double phase_of(const EffectTrial& trial, std::size_t run) {
    return trial.values[phase_place(*trial.effect)] + (trial.phase_of_run.empty() ? 0.0 : trial.phase_of_run[run]);
}
void set_phases(EffectTrial& trial, const std::vector<double>& phases) {
    const std::size_t place = phase_place(*trial.effect);
    trial.values[place] = phases[0] - std::floor(phases[0]);
    for (std::size_t run = 0; run < phases.size(); ++run) {
        const double ahead = phases[run] - phases[0];
        trial.phase_of_run[run] = ahead - std::round(ahead);
        trial.own[run][place] = trial.values[place];
    }
}

}  // namespace

bool Fitter::may_differ(const EffectInfo& effect) const {
    constexpr std::size_t rows_a_run = 40;
    return rig_.places_differ() && rig_.data().rows() >= rows_a_run * rig_.data().run_names.size() &&
           std::any_of(effect.parameters.begin(), effect.parameters.end(),
                       [&](const Parameter& p) { return is_own(effect, p); });
}

std::vector<double> Fitter::cost_of_runs(const Columns& residual) const {
    std::vector<double> cost(rig_.data().run_names.size(), 0.0);
    for (std::size_t c = 0; c < residual.size(); ++c)
        for (std::size_t i = 0; i < residual[c].size(); ++i)
            if (rig_.split().held_out[i] == 0 && !std::isnan(residual[c][i]))
                cost[static_cast<std::size_t>(rig_.data().run[i])] += scale_.cost(c, residual[c][i]);
    return cost;
}

void Fitter::centre(FittedModel& model, const EffectInfo& effect) const {
    for (std::size_t k = 0; k < effect.parameters.size(); ++k)
        if (free_parameters(effect)[k] && !is_own(effect, effect.parameters[k])) return;
    for (EffectTrial& trial : model.effects)
        for (std::size_t k = 0; trial.effect == &effect && k < trial.values.size(); ++k) {
            double mean = 0.0;
            for (const std::vector<double>& own : trial.own) mean += own[k] / static_cast<double>(trial.own.size());
            for (std::vector<double>& own : trial.own) own[k] -= mean;
        }
    model.residual = rig_.residual(model.base, model.effects);
    model.train_cost = cost_of(model);
}

void Fitter::keep_what_helps(FittedModel& model, std::size_t place, const EffectTrial& chance,
                             std::vector<double>& least) const {
    FittedModel other;
    other.base = model.base;
    other.effects = model.effects;
    other.effects[place] = chance;
    const std::vector<double> cost = cost_of_runs(rig_.residual(other.base, other.effects));
    EffectTrial& now = model.effects[place];
    const bool turns = !now.phase_of_run.empty();
    std::vector<double> phases;
    for (std::size_t run = 0; run < cost.size(); ++run) {
        const bool helps = cost[run] < least[run];
        if (turns) phases.push_back(phase_of(helps ? chance : now, run));
        if (!helps) continue;
        least[run] = cost[run];
        now.own[run] = chance.own[run];
    }
    if (turns) set_phases(now, phases);
}

void Fitter::sweep_runs(FittedModel& model, std::size_t place) const {
    constexpr int places = 40;
    const EffectInfo& effect = *model.effects[place].effect;
    const std::vector<bool>& free = free_parameters(effect);
    std::vector<double> least = cost_of_runs(model.residual);
    turn_runs(model, place, least);
    for (std::size_t k = 0; k < free.size(); ++k) {
        const Parameter& p = effect.parameters[k];
        if (!free[k] || !is_own(effect, p) || is_direction(p) || is_strength(effect, p)) continue;
        for (int j = 0; j <= places; ++j) {
            const double part = static_cast<double>(j) / places;
            EffectTrial chance = model.effects[place];
            for (std::vector<double>& own : chance.own) own[k] = p.minimum + part * part * (p.maximum - p.minimum);
            keep_what_helps(model, place, chance, least);
        }
    }
    model.residual = rig_.residual(model.base, model.effects);
    model.train_cost = cost_of(model);
}

void Fitter::turn_runs(FittedModel& model, std::size_t place, std::vector<double>& least) const {
    constexpr int turns = 16;
    if (model.effects[place].phase_of_run.empty()) return;
    const EffectTrial from = model.effects[place];
    for (int k = 1; k < turns; ++k) {
        EffectTrial chance = from;
        std::vector<double> phases;
        for (std::size_t run = 0; run < chance.own.size(); ++run)
            phases.push_back(phase_of(chance, run) + static_cast<double>(k) / turns);
        set_phases(chance, phases);
        keep_what_helps(model, place, chance, least);
    }
}

void Fitter::reverse_runs(FittedModel& model, std::size_t place) const {
    const EffectInfo& effect = *model.effects[place].effect;
    const std::vector<bool>& free = free_parameters(effect);
    const std::size_t runs = model.effects[place].own.size();
    for (std::size_t turn = 0; turn <= runs; ++turn) {  // all of them at last
        FittedModel other = model;
        bool turned = false;
        for (std::size_t k = 0; k < free.size(); ++k) {
            if (!free[k] || !is_direction(effect.parameters[k])) continue;
            for (std::size_t run = 0; run < runs; ++run)
                if (turn == runs || turn == run) other.effects[place].own[run][k] *= -1.0;
            turned = true;
        }
        if (!turned) return;
        other.residual = rig_.residual(other.base, other.effects);
        std::vector<double> least = cost_of_runs(other.residual);
        turn_runs(other, place, least);
        refit(other, 8);
        if (other.train_cost < model.train_cost) model = std::move(other);
    }
}

FittedModel Fitter::each_run_its_own(FittedModel model, const EffectInfo& effect) const {
    constexpr std::uint64_t anywhere = 50, draws = 150;
    constexpr double widest = 0.3, narrowest = 0.01;  // of the ranges
    const std::vector<bool>& free = free_parameters(effect);
    const std::size_t runs = rig_.data().run_names.size();
    const auto place = static_cast<std::size_t>(&trial_of(model, effect) - model.effects.data());
    model.effects[place].own.assign(runs, model.effects[place].values);
    model.residual = rig_.residual(model.base, model.effects);
    std::vector<double> least = cost_of_runs(model.residual);
    // All recordings take a chance at once, and each keeps what helped it.
    for (std::uint64_t draw = 0; draw < draws; ++draw) {
        const double shrunk = static_cast<double>(draw) / static_cast<double>(draws);
        const double width = widest * std::pow(narrowest / widest, shrunk);
        EffectTrial now = model.effects[place];
        for (std::size_t run = 0; run < runs; ++run) {
            const std::uint64_t at = 64 * run;
            for (std::size_t k = 0; k < free.size(); ++k) {
                const Parameter& p = effect.parameters[k];
                if (!free[k] || !is_own(effect, p)) continue;
                const double range = p.maximum - p.minimum;
                if (draw < anywhere) {
                    const double u = random_uniform(2, RandomStream::optimiser, draw, at + k);
                    now.own[run][k] = p.minimum + range * (p.minimum < 0.0 ? u : u * u * u);
                } else {
                    const double z = random_normal(3, RandomStream::optimiser, draw, at + k);
                    const double size = p.minimum < 0.0 ? range : std::min(range, 0.5 + 2.0 * now.own[run][k]);
                    now.own[run][k] = std::clamp(now.own[run][k] + width * size * z, p.minimum, p.maximum);
                }
            }
            if (run == 0 || now.phase_of_run.empty()) continue;
            double& phase = now.phase_of_run[run];
            phase = draw < anywhere ? random_uniform(4, RandomStream::optimiser, draw, run) - 0.5
                                    : phase + 0.5 * width * random_normal(4, RandomStream::optimiser, draw, run);
            phase -= std::round(phase);
        }
        keep_what_helps(model, place, now, least);
    }
    model.residual = rig_.residual(model.base, model.effects);
    refit(model, 15);
    return model;
}

void Fitter::settle_runs(FittedModel& model, const EffectInfo& effect) const {
    constexpr int rounds = 4;
    constexpr double least_gain = 0.01;
    const auto place = static_cast<std::size_t>(&trial_of(model, effect) - model.effects.data());
    const double known = known_rows(model.residual, rig_.split(), 0);
    for (int round = 0; round < rounds; ++round) {
        const Fitter near = closer(model);
        const double before = near.misfit(model);
        near.sweep_runs(model, place);
        near.refit(model, 15);
        near.reverse_runs(model, place);
        if (near.misfit(model) > before + std::log(1.0 - least_gain) * known) break;
    }
    model.train_cost = cost_of(model);
}

EffectTrial Fitter::turned(const FittedModel& from, const EffectTrial& trial) const {
    constexpr int places = 8;
    EffectTrial best = trial;
    const std::size_t phase = phase_place(*trial.effect), runs = rig_.data().run_names.size();
    if (phase == trial.values.size() || !free_parameters(*trial.effect)[phase]) return best;
    std::vector<double> least(runs, std::numeric_limits<double>::infinity()), place(runs, 0.0);
    std::vector<double> all(places, 0.0);
    for (int k = 0; k < places; ++k) {
        EffectTrial there = trial;
        there.values[phase] = static_cast<double>(k) / places;
        std::vector<double> cost(runs, 0.0);
        const Columns left = rig_.residual(from.base, beside(from, there).effects);
        for (std::size_t c = 0; c < left.size(); ++c)
            for (std::size_t i = 0; i < left[c].size(); ++i)
                if (rig_.split().held_out[i] == 0 && !std::isnan(left[c][i]))
                    cost[static_cast<std::size_t>(rig_.data().run[i])] += scale_.cost(c, left[c][i]);
        for (std::size_t run = 0; run < runs; ++run) {
            all[static_cast<std::size_t>(k)] += cost[run];
            if (cost[run] >= least[run]) continue;
            least[run] = cost[run];
            place[run] = there.values[phase];
        }
    }
    // Recordings that are long enough to say so each have their own.
    constexpr std::size_t rows_a_run = 40;
    if (runs > 1 && rig_.data().rows() >= rows_a_run * runs) {
        best.values[phase] = place[0];
        best.phase_of_run.assign(runs, 0.0);
        for (std::size_t run = 1; run < runs; ++run) {
            const double ahead = place[run] - place[0];
            best.phase_of_run[run] = ahead > 0.5 ? ahead - 1.0 : (ahead < -0.5 ? ahead + 1.0 : ahead);
        }
    } else {
        best.values[phase] = static_cast<double>(std::min_element(all.begin(), all.end()) - all.begin()) / places;
    }
    return best;
}

}  // namespace cathlab
