// Recordings that were each taken at another place: an effect with numbers of their own.
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/random.h"
#include "explain/fit.h"

namespace cathlab {

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

FittedModel Fitter::each_run_its_own(FittedModel model, const EffectInfo& effect) const {
    constexpr std::uint64_t anywhere = 50, draws = 150;
    constexpr double widest = 0.3, narrowest = 0.01;  // of the ranges
    const std::vector<bool>& free = free_parameters(effect);
    const std::size_t runs = rig_.data().run_names.size();
    const auto place = static_cast<std::size_t>(
        std::find_if(model.effects.begin(), model.effects.end(), [&](const auto& t) { return t.effect == &effect; }) -
        model.effects.begin());
    model.effects[place].own.assign(runs, model.effects[place].values);
    model.residual = rig_.residual(model.base, model.effects);
    std::vector<double> least = cost_of_runs(model.residual);
    // All recordings take a chance at once, and each keeps what helped it.
    FittedModel other = model;
    for (std::uint64_t draw = 0; draw < draws; ++draw) {
        const double shrunk = static_cast<double>(draw) / static_cast<double>(draws);
        const double width = widest * std::pow(narrowest / widest, shrunk);
        EffectTrial& now = other.effects[place];
        now = model.effects[place];
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
        const std::vector<double> cost = cost_of_runs(rig_.residual(other.base, other.effects));
        for (std::size_t run = 0; run < runs; ++run) {
            if (cost[run] >= least[run]) continue;
            least[run] = cost[run];
            model.effects[place].own[run] = now.own[run];
            if (!now.phase_of_run.empty()) model.effects[place].phase_of_run[run] = now.phase_of_run[run];
        }
    }
    model.residual = rig_.residual(model.base, model.effects);
    refit(model, 15);
    return model;
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
