// From a recording to a verdict: how far the model is off, whether that is more than noise, and which effect it lacks.
#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "explain/dataset.h"
#include "explain/residual.h"

namespace cathlab {

enum class Verdict { nothing_missing, explained, partly_explained, unexplained };
std::string verdict_text(Verdict verdict);  ///< "nothing missing", ...

struct FittedEffect {
    std::string name;
    std::vector<std::pair<std::string, double>> parameters;
    double p_value = 1.0;  ///< after Bonferroni's correction for the candidates tried
    double held_out_before = 0.0, held_out_after = 0.0;
};

struct Candidate {
    std::string name;
    double held_out_rms = 0.0;    ///< NaN where it could not be tried
    double p_value = 1.0;         ///< corrected
    std::string refused_because;  ///< "" = taken
};

/// Something left over that has a form.
struct Structure {
    std::string what;        ///< "oscillation", "outliers", "correlation"
    std::string depends_on;  ///< a measured column
    double period_s = 0.0, amplitude = 0.0;
    std::string text;
};

struct Explanation {
    Verdict verdict = Verdict::unexplained;
    std::vector<FittedEffect> effects;
    std::vector<std::pair<std::string, double>> base_parameters;
    double noise_floor = 0.0;  ///< as declared, otherwise estimated by differences; root mean square a measured column
    double train_before = 0.0, train_after = 0.0, held_out_before = 0.0, held_out_after = 0.0;
    std::vector<Candidate> candidates;
    std::vector<Structure> left_over;
    std::vector<std::string> cannot;  ///< what this program could not do with these data, a sentence each
    std::string overlay;              ///< TOML to lay over a scene; "" where no effect was found
};

struct ExplainOptions {
    int max_effects = 2;  ///< 0 or more
    int threads = 1;      ///< do not change the result
    std::uint64_t seed = 1;
    std::function<bool(double part_done)> on_progress;  ///< false = stop: throws UserError, nothing was written
};

/// The base model is fitted on the training rows.  Every effect of the manifest that applies to the kind, and was not
/// declared, is fitted inside the model on the same rows: a swarm, then local searches, also from the periods that the
/// residual's spectrum shows.  An effect is taken when the held-out error falls by more than a sign-flip permutation of
/// blocks of time would give by chance (corrected p below 0.01) by at least 2 %, and no parameter with a unit ends on a
/// bound of its range.  Parameters that the data cannot tell apart stay near their defaults: the objective has a ridge
/// of 1e-4 of its value.  Effects are taken one after another; what has been taken is not fitted again beside a later
/// one. Throws UserError for kinds without a rig and for data that do not determine the base model.
Explanation explain(const Dataset& data, const ExplainOptions& options = {});

}  // namespace cathlab
