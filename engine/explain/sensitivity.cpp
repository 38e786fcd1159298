#include "explain/sensitivity.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <mutex>

#include "core/errors.h"
#include "explain/fit.h"

namespace cathlab {
namespace {

constexpr double over_noise = 5.0, too_weak = 2.0;

bool is_strength(const EffectInfo& effect, std::string_view key) {
    return std::find(effect.strengths.begin(), effect.strengths.end(), key) != effect.strengths.end();
}

/// Usual numbers, the strengths at a part of their ranges; where recordings may have their own, only the last has it.
EffectTrial at_level(const EffectInfo& effect, double level, std::size_t runs, bool own) {
    EffectTrial out{&effect, {}};
    std::vector<double> none;
    for (const Parameter& p : effect.parameters) {
        const bool strength = is_strength(effect, p.key);
        out.values.push_back(strength ? level * p.maximum : p.default_value);
        none.push_back(strength ? 0.0 : p.default_value);
    }
    if (own && runs > 1) {
        out.own.assign(runs, none);
        out.own.back() = out.values;
    }
    return out;
}

/// The model's columns: what was measured, less what is left of it.
Columns modelled(const Rig& rig, std::span<const double> base, std::span<const EffectTrial> effects) {
    Columns out = rig.residual(base, effects);
    for (std::size_t c = 0; c < out.size(); ++c)
        for (std::size_t i = 0; i < out[c].size(); ++i) out[c][i] = rig.measured()[c]->values[i] - out[c][i];
    return out;
}

/// The recording with other numbers measured, and what it takes to fit models to it.
struct Made {
    Made(const Dataset& like, const Split& split, const Columns& measured, std::span<const EffectInfo* const> effects,
         double noise, const Crew& crew)
        : data(like) {
        std::size_t c = 0;
        for (DataColumn& column : data.columns)
            if (column.role == ColumnRole::measured) column.values = measured[c++];
        rig = make_rig(data, split, crew);
        fitter = std::make_unique<Fitter>(*rig, noise, crew);
        for (const EffectInfo* effect : effects) fitter->learn(*effect);
        base = fitter->begin();
        before = rms_of(base.residual, split, 1);
    }
    Dataset data;
    std::unique_ptr<Rig> rig;
    std::unique_ptr<Fitter> fitter;
    FittedModel base;
    double before = 0.0;
};

}  // namespace

Sensitivity sensitivity(const Dataset& data, const ExplainOptions& options) {
    const Split split = split_rows(data);
    const Crew crew(options.threads);
    const std::unique_ptr<Rig> rig = make_rig(data, split, crew);
    Fitter fitter(*rig, data.sensor_noise, crew);
    std::vector<const EffectInfo*> effects;
    Sensitivity out;
    out.response_over_noise = over_noise;
    for (const EffectInfo& effect : effect_table()) {
        const auto& kinds = effect.applies_to;
        if (effect.for_tests || std::find(kinds.begin(), kinds.end(), data.kind) == kinds.end()) continue;
        if (!rig->why_not(effect).empty()) continue;
        if (fitter.learn(effect))
            effects.push_back(&effect);
        else
            out.taken_up.push_back(spoken_name(effect));
    }
    const FittedModel fitted = fitter.begin();
    double noise = data.sensor_noise;
    if (!(noise > 0.0)) noise = 0.2 * rms_of(fitted.residual, split, 0);
    const Columns plain = modelled(*rig, fitted.base, {});

    // Each effect so strong that what the base model cannot take up of it is so many times the noise.
    std::vector<std::unique_ptr<Made>> made(effects.size());
    std::vector<char> weak(effects.size(), 0);
    std::atomic<std::size_t> done{0};
    std::atomic<bool> stop{false};
    std::mutex telling;
    const std::size_t all = effects.size() * (effects.size() + 1);
    const auto tell = [&](std::size_t more) {
        const double part = static_cast<double>(done += more) / static_cast<double>(all);
        if (!options.on_progress) return;
        const std::lock_guard lock(telling);
        if (!options.on_progress(part)) stop = true;
    };
    crew.each(effects.size(), [&](std::size_t k) {
        if (stop) return;
        constexpr int rounds = 6;
        double level = 0.02, seen = 0.0;
        for (int round = 0; round < rounds; ++round) {
            const EffectTrial trial = at_level(*effects[k], level, data.run_names.size(), rig->places_differ());
            const Columns there = modelled(*rig, fitted.base, std::span(&trial, 1));
            made[k] = std::make_unique<Made>(data, split, there, effects, noise, crew);
            seen = made[k]->before;
            const double miss = seen / (over_noise * noise);
            if ((miss > 0.8 && miss < 1.25) || (level >= 1.0 && miss < 1.0)) break;
            level = std::min(1.0, level * std::clamp(miss > 0.0 ? 1.0 / miss : 10.0, 0.1, 10.0));
        }
        weak[k] = seen < too_weak * noise;
        tell(1);
    });
    std::vector<std::pair<std::size_t, std::size_t>> two;
    for (std::size_t a = 0; a < effects.size(); ++a) {
        if (weak[a] != 0) out.too_weak.push_back(spoken_name(*effects[a]));
        for (std::size_t b = 0; weak[a] == 0 && b < effects.size(); ++b)
            if (a != b) two.emplace_back(a, b);
    }
    out.pairs.resize(two.size());
    crew.each(two.size(), [&](std::size_t k) {
        if (stop) return;
        const auto [a, b] = two[k];
        const Made& recording = *made[a];
        const FittedModel model = recording.fitter->with(recording.base, *effects[b]);
        out.pairs[k] = {spoken_name(*effects[a]), spoken_name(*effects[b]),
                        rms_of(model.residual, split, 1) / recording.before};
        tell(1);
    });
    if (stop) throw UserError("stopped; nothing was written");
    std::stable_sort(out.pairs.begin(), out.pairs.end(),
                     [](const Likeness& x, const Likeness& y) { return x.left < y.left; });
    return out;
}

}  // namespace cathlab
