#include "explain/tracer.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <map>
#include <mutex>
#include <set>
#include <sstream>

#include "core/errors.h"
#include "core/svg_plot.h"
#include "explain/fit.h"
#include "explain/residual.h"

namespace cathlab {
namespace {

constexpr double significant = 0.01;
constexpr double not_apart = 0.05;      // above it two models explain alike
constexpr double least_gain = 0.01;     // of the held-out error
constexpr double floor_factor = 1.15;   // a residual this near to the noise is noise
constexpr std::size_t kept_models = 3;  // from round to round

std::set<std::string_view> names_of(const FittedModel& model) {
    std::set<std::string_view> out;
    for (const EffectTrial& trial : model.effects) out.insert(trial.effect->name);
    return out;
}

bool holds(const FittedModel& model, const EffectInfo* effect) {
    return std::any_of(model.effects.begin(), model.effects.end(),
                       [&](const EffectTrial& trial) { return trial.effect == effect; });
}

std::string overlay_text(const std::vector<FittedEffect>& effects) {
    std::ostringstream out;
    if (std::any_of(effects.begin(), effects.end(), [](const FittedEffect& e) { return e.info->elastic_wall; }))
        out << "# Effects of the wall's law want a wall that has one.\n[wall]\nform = \"elastic\"\n";
    for (const FittedEffect& effect : effects) {
        out << "[effects." << effect.info->name << "]\nenabled = true\n";
        for (const auto& [key, value] : effect.parameters) {
            std::ostringstream number;
            number.precision(9);
            number << value;
            const std::string text = number.str();
            out << key << " = " << text << (text.find_first_of(".en") == std::string::npos ? ".0" : "") << "\n";
        }
    }
    return out.str();
}

double noise_of(const Dataset& data, const Columns& residual, std::size_t count) {
    double sum = 0.0;
    for (std::size_t c = 0; c < count; ++c) {
        const double noise = noise_by_differences(residual[c], data.run);
        sum += std::isnan(noise) ? 0.0 : noise * noise;
    }
    return std::sqrt(sum / static_cast<double>(count));
}

/// A model that was tried: what it came from, and how it does.
struct Child {
    std::size_t parent = 0;
    const EffectInfo* effect = nullptr;
    FittedModel model;
    double held_out_cost = 0.0, p = 1.0;
    std::string refused;
    bool on_bound = false;  ///< nothing else is against it
    bool hidden = false;    ///< it helps, but not by more than chance allows
};

/// The search of one explanation.
class Search {
public:
    Search(const Dataset& data, const ExplainOptions& options)
        : data_(data),
          options_(options),
          split_(split_rows(data)),
          crew_(options.threads),
          rig_(make_rig(data, split_, crew_)),
          fitter_(*rig_, data.sensor_noise, crew_) {}

    Explanation run() {
        out_.cannot = rig_->notes();
        choose_candidates();
        FittedModel base = fitter_.begin(declared_);
        out_.split = split_;
        ask_own_error();
        out_.before = base.residual;
        out_.train_before = rms_of(base.residual, split_, 0);
        out_.held_out_before = rms_of(base.residual, split_, 1);
        best_ = base;
        kept_ = {base};
        for (round_ = 0; round_ < options_.max_effects; ++round_)
            if (!next_round()) break;
        FittedModel best = best_;
        drop_what_is_not_needed(best);
        finish(best);
        return std::move(out_);
    }

private:
    void choose_candidates() {
        for (const std::string& name : data_.declared_effects) {
            const EffectInfo* effect = find_effect(name);
            if (effect == nullptr) {
                out_.cannot.push_back("'" + name + "' is declared, but this program knows no effect of that name");
                continue;
            }
            const std::string why = rig_->why_not(*effect);
            if (!why.empty() || !fitter_.learn(*effect))
                out_.cannot.push_back("'" + name + "' is declared, but cannot act here" +
                                      (why.empty() ? "" : ": " + why));
            else
                declared_.push_back(effect);
        }
        for (const EffectInfo& effect : effect_table()) {
            const auto& kinds = effect.applies_to;
            if (effect.for_tests || std::find(kinds.begin(), kinds.end(), data_.kind) == kinds.end()) continue;
            if (std::find(declared_.begin(), declared_.end(), &effect) != declared_.end()) continue;
            Candidate candidate{
                spoken_name(effect), std::numeric_limits<double>::quiet_NaN(), 1.0, rig_->why_not(effect), {}};
            if (candidate.refused_because.empty() && !fitter_.learn(effect))
                candidate.refused_because = "none of its parameters changes anything here";
            if (candidate.refused_because.empty()) tried_.push_back(&effect);
            out_.candidates.push_back(std::move(candidate));
        }
    }

    Candidate& row_of(const EffectInfo& effect) {
        const std::string name = spoken_name(effect);
        return *std::find_if(out_.candidates.begin(), out_.candidates.end(),
                             [&](const Candidate& c) { return c.name == name; });
    }

    /// Every candidate beside every kept model; false where nothing more is found.
    bool next_round() {
        fitter_.weigh_by(kept_[0]);
        std::vector<Child> children;
        std::set<std::set<std::string_view>> sets;
        for (std::size_t parent = 0; parent < kept_.size(); ++parent)
            for (const EffectInfo* effect : tried_) {
                if (holds(kept_[parent], effect)) continue;
                std::set<std::string_view> names = names_of(kept_[parent]);
                names.insert(effect->name);
                if (!sets.insert(names).second) continue;
                children.emplace_back();
                children.back().parent = parent;
                children.back().effect = effect;
            }
        if (children.empty()) return false;
        fit_all(children);
        std::vector<Child*> accepted, promising;
        const double known = mean_cost(best_.residual, split_, 1, fitter_.scale());
        by_chance(children);
        for (Child& child : children) {
            judge(child);
            // A number on its bound may come off it beside another effect, and what is no more than chance while
            // another effect hides it may show beside that one.
            if (child.refused.empty() || child.on_bound) promising.push_back(&child);
            if (child.refused.empty() && child.held_out_cost < known) accepted.push_back(&child);
        }
        for (Child& child : children)
            if (accepted.empty() && child.hidden) promising.push_back(&child);
        const auto better = [](const Child* a, const Child* b) { return a->held_out_cost < b->held_out_cost; };
        std::stable_sort(accepted.begin(), accepted.end(), better);
        std::stable_sort(promising.begin(), promising.end(), better);
        if (!accepted.empty() && !beats_plain_shapes(*accepted[0])) accepted.clear();
        note(children, accepted);
        if (!accepted.empty()) find_equals(accepted);
        // Where a model takes seconds only what was found is gone on from.
        if (promising.empty() || (accepted.empty() && (rig_->slow() || !plain_better_.empty()))) return false;
        // Those that are far behind the best will not overtake it.
        const double before = mean_cost(kept_[0].residual, split_, 1, fitter_.scale());
        const double enough = before - 0.5 * (before - promising[0]->held_out_cost);
        if (!accepted.empty()) {
            anchor_at(accepted[0]->model);
            best_ = accepted[0]->model;
            chance_[accepted[0]->effect] = accepted[0]->p;
        }
        std::vector<FittedModel> next;
        for (std::size_t k = 0; k < std::min(rig_->slow() ? std::size_t{1} : kept_models, promising.size()); ++k)
            if (promising[k]->held_out_cost <= enough) next.push_back(std::move(promising[k]->model));
        kept_ = std::move(next);
        const double left = rms_of(best_.residual, split_, 1);
        return !(left <= floor_factor * std::hypot(data_.sensor_noise, out_.model_error));  // explained
    }

    /// How far the model is off as it is corrected now.
    void ask_own_error() {
        own_error_ = rig_->own_error();
        double square = 0.0;
        const std::size_t judged = split_.judged > 0 ? std::min(split_.judged, own_error_.size()) : own_error_.size();
        for (std::size_t c = 0; c < judged; ++c) square += own_error_[c] * own_error_[c] / static_cast<double>(judged);
        out_.model_error = std::sqrt(square);
    }

    /// What the rig corrects, it corrects about this model from now on.
    void anchor_at(FittedModel& model) {
        if (!rig_->slow()) return;
        rig_->anchor(model.effects);
        ask_own_error();
        model.residual = rig_->residual(model.base, model.effects);
        fitter_.refit(model, 6);
    }

    void fit_all(std::vector<Child>& children) {
        std::atomic<std::size_t> done{0};
        std::atomic<bool> stop{false};
        std::mutex telling;
        crew_.each(children.size(), [&](std::size_t k) {
            if (stop) return;
            children[k].model = fitter_.with(kept_[children[k].parent], *children[k].effect);
            const double part = static_cast<double>(++done) / static_cast<double>(children.size());
            if (!options_.on_progress) return;
            const std::lock_guard lock(telling);
            if (!options_.on_progress((round_ + part) / (options_.max_effects + 1.0))) stop = true;
        });
        if (stop) throw UserError("stopped; nothing was written");
    }

    /// By the best of all that were tried.  A parent that was not accepted itself proves nothing: beside it, the last
    /// model that was has to be beaten.
    void by_chance(std::vector<Child>& children) const {
        std::vector<Comparison> beside_parent, beside_best;
        for (const Child& child : children) {
            beside_parent.push_back({&kept_[child.parent].residual, &child.model.residual});
            beside_best.push_back({&best_.residual, &child.model.residual});
        }
        const std::vector<double> a = gains_by_chance(beside_parent, split_, fitter_.scale(), options_.seed);
        const std::vector<double> b = gains_by_chance(beside_best, split_, fitter_.scale(), options_.seed);
        for (std::size_t k = 0; k < children.size(); ++k) children[k].p = std::max(a[k], b[k]);
    }

    void judge(Child& child) {
        const FittedModel& parent = kept_[child.parent];
        const LossScale& scale = fitter_.scale();
        const double before = mean_cost(parent.residual, split_, 1, scale);
        child.held_out_cost = mean_cost(child.model.residual, split_, 1, scale);
        const auto trial = std::find_if(child.model.effects.begin(), child.model.effects.end(),
                                        [&](const EffectTrial& t) { return t.effect == child.effect; });
        const double gain = 1.0 - std::sqrt(child.held_out_cost / before);
        if (child.p >= significant)
            child.refused = "the held-out error does not fall by more than chance allows";
        else if (gain < least_gain)
            child.refused = "the held-out error falls by less than 1 %";
        else if (!beyond_own_error(parent.residual, child.model.residual))
            child.refused = "it explains less than the base model is itself off";
        else if (split_.judged > 0 &&
                 rms_of(child.model.residual, split_, 1) > (1.0 + least_gain) * rms_of(parent.residual, split_, 1))
            child.refused = "it comes nearer to the force alone, and further from what is judged";
        else
            child.refused = why_no_effect(*trial, fitter_.free_parameters(*child.effect));
        constexpr double much = 0.03;
        child.hidden = !rig_->slow() && child.p >= significant && gain >= much &&
                       why_no_effect(*trial, fitter_.free_parameters(*child.effect)).empty();
        if (child.p >= significant || gain < least_gain) return;
        if (child.refused.empty())
            for (const EffectTrial& other : child.model.effects) {
                const std::string why = why_no_effect(other, fitter_.free_parameters(*other.effect));
                if (!why.empty() && child.refused.empty())
                    child.refused = "of '" + spoken_name(*other.effect) + "' beside it " + why;
            }
        child.on_bound = child.refused.find("on a bound") != std::string::npos;
    }

    /// Whether a model is better than another, in some column, by more than the base model is itself off.
    bool beyond_own_error(const Columns& before, const Columns& after) const {
        if (own_error_.empty()) return true;
        for (std::size_t c = 0; c < before.size(); ++c) {
            const double b = rms(before[c], split_.held_out, 1), a = rms(after[c], split_.held_out, 1);
            if (b * b - a * a > own_error_[c] * own_error_[c]) return true;
        }
        return false;
    }

    /// What was measured beside the columns that are judged, a force: what is left of it is noise, or not more than
    /// twice what the base model is off.
    bool others_are_noise(const Columns& residual) const {
        constexpr double more = 2.0;
        for (std::size_t c = split_.judged; split_.judged > 0 && c < own_error_.size(); ++c)
            if (rms(residual[c], split_.held_out, 1) >
                more * std::hypot(own_error_[c], noise_by_differences(residual[c], data_.run)))
                return false;
        return true;
    }

    /// A sine that hardly comes round once within a recording is no oscillation: any curve is like a part of it.
    bool repeats(const Structure& shape) const {
        constexpr double turns = 1.5;
        double longest = 0.0;
        for (const double t : data_.time_s) longest = std::max(longest, t);
        return shape.what != "oscillation" || turns * shape.period_s <= longest;
    }

    /// What a sine or a step without a mechanism says better is not explained by an effect.
    bool beats_plain_shapes(const Child& child) {
        const Columns& before = kept_[child.parent].residual;
        const LossScale& scale = fitter_.scale();
        for (const auto& shape : {plain_oscillation(data_, split_, before), plain_step(data_, split_, before, scale)}) {
            if (!shape || !repeats(shape->says) || mean_cost(shape->residual, split_, 1, scale) >= child.held_out_cost)
                continue;
            if (gain_by_chance(child.model.residual, shape->residual, split_, scale, options_.seed) >= not_apart)
                continue;
            plain_better_ = shape->says.text;
            return false;
        }
        return true;
    }

    /// The table of candidates: how each did when it was first tried, and why it was refused.
    void note(const std::vector<Child>& children, const std::vector<Child*>& accepted) {
        for (const Child& child : children) {
            Candidate& row = row_of(*child.effect);
            if (!std::isnan(row.held_out_rms) && child.parent != 0) continue;
            row.held_out_rms = rms_of(child.model.residual, split_, 1);
            row.p_value = child.p;
            row.refused_because = child.refused;
            row.parameters.clear();
            for (const EffectTrial& trial : child.model.effects)
                for (std::size_t k = 0; trial.effect == child.effect && k < trial.values.size(); ++k)
                    row.parameters.emplace_back(std::string(child.effect->parameters[k].key), trial.values[k]);
            if (!child.refused.empty()) continue;
            if (accepted.empty())
                row.refused_because = "a shape without a mechanism says more: " + plain_better_;
            else if (&child != accepted[0])
                row.refused_because = "'" + spoken_name(*accepted[0]->effect) + "' explains more";
        }
    }

    /// Models that do as well as the best one with other effects.
    void find_equals(const std::vector<Child*>& accepted) {
        out_.ambiguous_with.clear();
        out_.parting.clear();
        const Child& best = *accepted[0];
        const auto known = names_of(best.model);
        for (std::size_t k = 1; k < accepted.size(); ++k) {
            const Child& other = *accepted[k];
            const double p =
                gain_by_chance(other.model.residual, best.model.residual, split_, fitter_.scale(), options_.seed);
            if (p < not_apart) continue;
            for (const EffectTrial& trial : other.model.effects) {
                const std::string name = spoken_name(*trial.effect);
                if (known.count(trial.effect->name) > 0 ||
                    std::find(out_.ambiguous_with.begin(), out_.ambiguous_with.end(), name) !=
                        out_.ambiguous_with.end())
                    continue;
                out_.ambiguous_with.push_back(name);
                if (out_.parting.empty()) out_.parting = where_they_differ(best, other);
            }
        }
    }

    std::string where_they_differ(const Child& a, const Child& b) const {
        double most = 0.0;
        std::size_t column = 0, row = 0;
        for (std::size_t c = 0; c < a.model.residual.size(); ++c)
            for (std::size_t i = 0; i < data_.rows(); ++i) {
                const double d = std::fabs(a.model.residual[c][i] - b.model.residual[c][i]);
                if (d > most) {
                    most = d;
                    column = c;
                    row = i;
                }
            }
        const DataColumn& measured = *rig_->measured()[column];
        std::string text = "'" + spoken_name(*a.effect) + "' and '" + spoken_name(*b.effect) + "' differ most, by " +
                           plain_number(most, 3) + " " + measured.unit + " in " + measured.name + ", at " +
                           plain_number(data_.time_s[row], 4) + " s of run " +
                           data_.run_names[static_cast<std::size_t>(data_.run[row])];
        std::string inputs;
        for (const DataColumn* input : data_.of_role(ColumnRole::input))
            inputs += (inputs.empty() ? "" : ", ") + input->name + " = " + plain_number(input->values[row], 4);
        if (!inputs.empty()) text += ", where " + inputs;
        return text + ": more rows there would part them";
    }

    void drop_what_is_not_needed(FittedModel& best) {
        std::size_t k = 0;
        fitter_.weigh_by(best);
        if (!rig_->slow() || best.effects.size() > 1) fitter_.refit(best, rig_->slow() ? 4 : 25);
        while (k < best.effects.size()) {
            const EffectInfo* effect = best.effects[k].effect;
            if (std::find(declared_.begin(), declared_.end(), effect) != declared_.end()) {
                ++k;
                continue;
            }
            const FittedModel without = fitter_.without(best, k);
            // What was taken was the best of all that were tried by that much; what came along with another one is
            // asked as if each had been tried for it.
            const auto taken = chance_.find(effect);
            const double alone =
                gain_by_chance(without.residual, best.residual, split_, fitter_.scale(), options_.seed);
            const double p =
                taken != chance_.end()
                    ? std::max(taken->second, std::min(1.0, static_cast<double>(best.effects.size()) * alone))
                    : std::min(1.0, static_cast<double>(tried_.size()) * alone);
            const double gain = 1.0 - std::sqrt(mean_cost(best.residual, split_, 1, fitter_.scale()) /
                                                mean_cost(without.residual, split_, 1, fitter_.scale()));
            const std::string none = why_no_effect(best.effects[k], fitter_.free_parameters(*effect));
            if (p >= significant || gain < 0.5 * least_gain || !none.empty() ||
                !beyond_own_error(without.residual, best.residual)) {
                row_of(*effect).refused_because =
                    none.empty() ? "no longer needed beside the others" : none + " beside the others";
                best = without;
                out_.effects.clear();
                // What did as well did so beside the effect that is gone.
                out_.ambiguous_with.clear();
                out_.parting.clear();
                k = 0;
                continue;
            }
            FittedEffect found{spoken_name(*effect), effect, {}, p, rms_of(without.residual, split_, 1), 0.0};
            const EffectTrial& trial = best.effects[k];
            for (std::size_t j = 0; j < effect->parameters.size(); ++j)
                found.parameters.emplace_back(std::string(effect->parameters[j].key),
                                              trial.own.empty() ? trial.values[j] : trial.own[0][j]);
            for (std::size_t run = 0; run < trial.own.size(); ++run)
                for (std::size_t j = 0; j < effect->parameters.size(); ++j)
                    if (is_own(*effect, effect->parameters[j]))
                        found.of_runs[data_.run_names[run]].emplace_back(std::string(effect->parameters[j].key),
                                                                         trial.own[run][j]);
            out_.effects.push_back(std::move(found));
            ++k;
        }
    }

    void finish(const FittedModel& best) {
        out_.after = best.residual;
        out_.train_after = rms_of(best.residual, split_, 0);
        out_.held_out_after = rms_of(best.residual, split_, 1);
        for (FittedEffect& effect : out_.effects) {
            effect.held_out_after = out_.held_out_after;
            row_of(*effect.info).refused_because.clear();
        }
        std::stable_sort(out_.effects.begin(), out_.effects.end(), [](const FittedEffect& a, const FittedEffect& b) {
            return a.held_out_before > b.held_out_before;
        });
        for (const FittedEffect& effect : out_.effects) std::erase(out_.ambiguous_with, effect.name);
        if (out_.effects.empty()) out_.ambiguous_with.clear();
        if (out_.ambiguous_with.empty()) out_.parting.clear();
        out_.base_parameters = rig_->parameters(best.base, best.effects);
        out_.estimated_noise = noise_of(data_, best.residual, split_.judged);
        out_.noise_floor = data_.sensor_noise > 0.0 ? data_.sensor_noise : out_.estimated_noise;
        fitter_.weigh_by(best);
        const bool noise_only = out_.held_out_after <= floor_factor * std::hypot(out_.noise_floor, out_.model_error) &&
                                others_are_noise(best.residual);
        if (out_.effects.empty())
            out_.verdict = noise_only ? Verdict::nothing_missing : Verdict::unexplained;
        else
            out_.verdict = noise_only ? Verdict::explained : Verdict::partly_explained;
        out_.left_over = describe_structure(data_, split_, best.residual, fitter_.scale(), options_.seed);
        if (!noise_only) out_.empirical = fit_empirical(data_, split_, best.residual, fitter_.scale(), options_.seed);
        out_.overlay = overlay_text(out_.effects);
        if (options_.on_progress && !options_.on_progress(1.0)) throw UserError("stopped; nothing was written");
    }

    const Dataset& data_;
    const ExplainOptions& options_;
    Split split_;
    Crew crew_;
    std::unique_ptr<Rig> rig_;
    Fitter fitter_;
    std::vector<const EffectInfo*> declared_, tried_;
    FittedModel best_;               ///< that may be named
    std::vector<FittedModel> kept_;  ///< from which the next round begins
    std::vector<double> own_error_;  ///< of the rig
    std::string plain_better_;
    std::map<const EffectInfo*, double> chance_;  ///< of those that were taken
    int round_ = 0;
    Explanation out_;
};

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
    return Search(data, options).run();
}

}  // namespace cathlab
