// From a recording to a verdict: how far the model is off, whether that is more than noise, and which effect it lacks.
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "explain/dataset.h"
#include "explain/rig.h"
#include "explain/structure.h"

namespace cathlab {

enum class Verdict { nothing_missing, explained, partly_explained, unexplained };
std::string verdict_text(Verdict verdict);  ///< "nothing missing", ...

struct FittedEffect {
    std::string name;  ///< as data sets write it, with hyphens
    const EffectInfo* info = nullptr;
    NamedNumbers parameters;
    double p_value = 1.0;          ///< of the model without it against the model with it, corrected for the tries
    double held_out_before = 0.0;  ///< of the model without it, fitted again
    double held_out_after = 0.0;   ///< of the whole model
    /// Where recordings have numbers of their own (`parameters` are then the first one's), by the name of the run.
    std::map<std::string, NamedNumbers> of_runs = {};
};

struct Candidate {
    std::string name;
    double held_out_rms = 0.0;    ///< NaN where it could not be tried
    double p_value = 1.0;         ///< corrected
    std::string refused_because;  ///< "" = taken
    NamedNumbers parameters;      ///< as fitted when it was first tried
};

struct Explanation {
    Verdict verdict = Verdict::unexplained;
    std::vector<FittedEffect> effects;  ///< what helps most first
    NamedNumbers base_parameters;
    double noise_floor = 0.0;      ///< as declared, otherwise as estimated; root mean square a measured column
    double model_error = 0.0;      ///< by which the base model itself is known to be off; 0 = it is exact
    double estimated_noise = 0.0;  ///< from differences of neighbours of what is left
    double train_before = 0.0, train_after = 0.0, held_out_before = 0.0, held_out_after = 0.0;
    std::vector<Candidate> candidates;
    std::vector<std::string> ambiguous_with;  ///< names that these data do not tell from the effects found
    std::string parting;                      ///< where their predictions differ most: what to record
    std::vector<Structure> left_over;
    std::optional<EmpiricalModel> empirical;
    std::vector<std::string> cannot;  ///< what this program could not do with these data, a sentence each
    std::string overlay;              ///< TOML to lay over a scene; "" where no effect was found
    Columns before, after;            ///< residuals of base model and final model
    Split split;
};

struct ExplainOptions {
    int max_effects = 3;  ///< 0 or more
    int threads = 1;      ///< do not change the result
    std::uint64_t seed = 1;
    std::function<bool(double part_done)> on_progress;  ///< false = stop: throws UserError, nothing was written
};

/// The base model, with the declared effects in it, is fitted on the training rows.  Every other effect of the manifest
/// that applies to the kind is fitted inside the model on the same rows, beside what the three best models so far
/// hold.  It is taken when the held-out error falls by more than flipped signs of whole blocks would give by chance
/// (p, times the number of tries, below 0.01) and by 1 % of itself at least, by more than a plain sine or step without
/// a mechanism, by more in some column than the base model is itself known to be off, when its strength is not zero and
/// no parameter ends on a bound of its range.  What is no longer needed
/// beside later ones is dropped.  Throws UserError for kinds without a rig and for data that do not determine the base
/// model.
Explanation explain(const Dataset& data, const ExplainOptions& options = {});

}  // namespace cathlab
