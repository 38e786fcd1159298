// Base models of many numbers have valleys.
#include <algorithm>
#include <cmath>

#include "core/random.h"
#include "explain/fit.h"

namespace cathlab {

FittedModel Fitter::begin(std::span<const EffectInfo* const> declared) {
    FittedModel model;
    model.base = rig_.start();
    model.residual = rig_.residual(model.base, {});
    const std::vector<Bound> bounds = rig_.bounds();
    if (!bounds.empty()) {
        // A search for angles has valleys: others begin around the first start, and the deepest is taken.
        constexpr int others = 11;
        constexpr double around = 0.06;  // of the ranges
        weigh_by(model);
        std::vector<FittedModel> tried(1 + others, model);
        crew_.each(tried.size(), [&](std::size_t k) {
            std::vector<double>& base = tried[k].base;
            for (std::size_t j = 0; k > 0 && j < base.size(); ++j) {
                const Bound& b = bounds[j];
                const double shift = random_normal(1, RandomStream::optimiser, k - 1, j);
                base[j] = std::clamp(base[j] + around * shift * (b.upper - b.lower), b.lower, b.upper);
            }
            refit(tried[k], 15);
        });
        std::stable_sort(tried.begin(), tried.end(),
                         [](const FittedModel& a, const FittedModel& b) { return a.train_cost < b.train_cost; });
        model = tried.front();
        keep_valleys(tried);
    }
    // The first fit sees large errors everywhere: its own scale, again and again until it stays.
    constexpr int rounds = 4;
    for (int k = 0; k < rounds; ++k) {
        weigh_by(model);
        const double before = model.train_cost;
        refit(model, 40);
        if (rig_.bounds().empty() || std::fabs(before - model.train_cost) < 1e-4 * model.train_cost) break;
    }
    for (const EffectInfo* effect : declared) {
        weigh_by(model);
        model = with(model, *effect);
    }
    weigh_by(model);
    model.train_cost = cost_of(model);
    return model;
}

void Fitter::keep_valleys(std::span<const FittedModel> tried) {
    constexpr std::size_t most = 4;
    constexpr double as_good = 1.3;    // times the least cost
    constexpr double elsewhere = 0.1;  // of a range, in some number
    const std::vector<Bound> bounds = rig_.bounds();
    valleys_.clear();
    if (bounds.size() <= few_numbers || rig_.slow()) return;
    const auto apart = [&](const std::vector<double>& a, const std::vector<double>& b) {
        double most_apart = 0.0;
        for (std::size_t k = 0; k < bounds.size(); ++k)
            most_apart = std::max(most_apart, std::fabs(a[k] - b[k]) / (bounds[k].upper - bounds[k].lower));
        return most_apart > elsewhere;
    };
    for (const FittedModel& model : tried) {
        if (valleys_.size() > most || model.train_cost > as_good * tried.front().train_cost) break;
        if (std::all_of(valleys_.begin(), valleys_.end(), [&](const auto& known) { return apart(model.base, known); }))
            valleys_.push_back(model.base);
    }
    valleys_.erase(valleys_.begin());  // the best one is gone on from in any case
}

std::vector<FittedModel> Fitter::in_other_valleys(const FittedModel& from, const EffectInfo& effect) const {
    std::vector<FittedModel> out;
    if (!from.effects.empty()) return out;
    for (const std::vector<double>& base : valleys_) {
        FittedModel there, best;
        there.base = base;
        there.residual = rig_.residual(base, {});
        for (const std::vector<double>& values : starts(there, effect)) {
            FittedModel model = beside(there, turned(there, {&effect, values}));
            model.residual = rig_.residual(model.base, model.effects);
            model.train_cost = cost_of(model);
            if (best.effects.empty() || model.train_cost < best.train_cost) best = std::move(model);
        }
        refit(best, 10, false);
        out.push_back(std::move(best));
    }
    return out;
}

}  // namespace cathlab
