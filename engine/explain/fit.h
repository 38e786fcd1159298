// Models fitted inside the rig: the base numbers and the effects' parameters together, on the rows that a fit may see.
#pragma once

#include <map>

#include "explain/judge.h"
#include "explain/rig.h"

namespace cathlab {

/// Base numbers that go along with an effect from the beginning; where they are more, it looks where to go first.
inline constexpr std::size_t few_numbers = 2;

struct FittedModel {
    std::vector<double> base;  ///< the rig's searched numbers
    std::vector<EffectTrial> effects;
    Columns residual;
    double train_cost = 0.0;  ///< mean, by the fitter's scale
};

class Fitter {
public:
    /// noise: the declared one, 0 = not known.
    /// crew: those who search; results do not depend on it.
    Fitter(const Rig& rig, double noise, const Crew& crew = Crew()) : rig_(rig), noise_(noise), crew_(crew) {}

    /// The base model with effects that are there without question.
    FittedModel begin(std::span<const EffectInfo* const> declared = {});

    /// Errors are weighed anew by what a model leaves.
    void weigh_by(const FittedModel& model);
    const LossScale& scale() const { return scale_; }

    /// Looks which of an effect's parameters change anything here: only those are searched, the others keep their
    /// defaults.  Called once for every effect, before it is tried.  False: none of them does.
    bool learn(const EffectInfo& effect);
    const std::vector<bool>& free_parameters(const EffectInfo& effect) const { return free_.at(&effect); }

    /// The model with one effect more, everything fitted together.  Several starts (periods from the spectrum of what
    /// is left, phases all around), of which the three best are searched.
    FittedModel with(const FittedModel& from, const EffectInfo& effect) const;

    /// The model without its effect number k, the rest fitted again.
    FittedModel without(const FittedModel& from, std::size_t k) const;

    /// Goes on from where the model is; base_too = false holds the base numbers.
    void refit(FittedModel& model, int iterations, bool base_too = true) const;
    void refit(FittedModel& model, int iterations, bool base_too, RigMemory* memory) const;

    const Rig& rig() const { return rig_; }

private:
    double cost_of(const FittedModel& model) const;
    /// How much is left in each column by what there was, all columns alike: the sum over them of rows x ln(mean cost).
    double misfit(const FittedModel& model) const;
    /// The same search with errors weighed by what a model leaves: a column that was far off counts as much as others.
    Fitter closer(const FittedModel& model) const {
        Fitter out = *this;
        out.weigh_by(model);
        return out;
    }
    /// A rig of few base numbers whose models take no time: shapes are searched together with the base numbers.
    bool quick() const;
    /// The model's numbers with one effect more; nothing fitted yet.
    FittedModel beside(const FittedModel& from, const EffectTrial& trial) const;
    /// The effect with its phase, in each run, where it helps most.
    EffectTrial turned(const FittedModel& from, const EffectTrial& trial) const;
    /// Whether recordings may have numbers of their own for it, and rows enough to say them.
    bool may_differ(const EffectInfo& effect) const;
    std::vector<double> cost_of_runs(const Columns& residual) const;
    /// Where all of an effect's numbers are the recordings' own, what they have alike is the heart's beat: taken out.
    void centre(FittedModel& model, const EffectInfo& effect) const;
    /// Effect number `place` as `chance` has it in those recordings where that costs less than `least`.
    void keep_what_helps(FittedModel& model, std::size_t place, const EffectTrial& chance,
                         std::vector<double>& least) const;
    /// Phases all around: each recording keeps what helps it.
    void turn_runs(FittedModel& model, std::size_t place, std::vector<double>& least) const;
    /// The same, and what has no slope where it is (a time at which something sets in) all over its range.
    void sweep_runs(FittedModel& model, std::size_t place) const;
    /// The effect the other way round in one recording after another, where that is better once it is fitted.
    void reverse_runs(FittedModel& model, std::size_t place) const;
    /// Numbers of their own for the recordings, searched from where the model is.
    FittedModel each_run_its_own(FittedModel model, const EffectInfo& effect) const;
    /// What all recordings have alike takes the shape that suits most of them, which shows the others that they are
    /// wrong: sweeps and reversals by turns, until nothing helps.
    void settle_runs(FittedModel& model, const EffectInfo& effect) const;
    /// Of the base models that were tried, best first: those that are nearly as good as the best and elsewhere.
    void keep_valleys(std::span<const FittedModel> tried);
    /// The effect where it begins best, beside base numbers of other valleys: it may be one of those that the world is
    /// in, and the base model alone cannot tell.
    std::vector<FittedModel> in_other_valleys(const FittedModel& from, const EffectInfo& effect) const;
    std::vector<std::vector<double>> starts(const FittedModel& from, const EffectInfo& effect) const;

    const Rig& rig_;
    double noise_;
    Crew crew_;
    LossScale scale_;
    std::vector<std::vector<double>>
        valleys_;  ///< base numbers at which the base model is nearly as good as at its best
    std::map<const EffectInfo*, std::vector<bool>> free_;
};

bool is_strength(const EffectInfo& effect, const Parameter& p);
bool is_phase(const Parameter& p);
bool is_direction(const Parameter& p);

/// What the model has of an effect that it holds.
const EffectTrial& trial_of(const FittedModel& model, const EffectInfo& effect);

/// Whether recordings of different places may each have this number for their own: how far and which way the effect
/// moves a place, and from when on.
bool is_own(const EffectInfo& effect, const Parameter& p);

/// In words, why a fitted effect is none: its strength is zero, or a parameter ends on a bound of its range.  "" = it
/// is one.
std::string why_no_effect(const EffectTrial& trial, const std::vector<bool>& free);

}  // namespace cathlab
