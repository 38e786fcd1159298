// Which effects such a recording could not tell apart, said beforehand: from what was commanded alone.
#pragma once

#include <string>
#include <vector>

#include "explain/tracer.h"

namespace cathlab {

/// What one effect leaves of another one's doing.
struct Likeness {
    std::string acting, fitted;  ///< names
    /// Held-out error with `fitted` in the model over that without any effect, where `acting` acts and nothing else, no
    /// noise: 0 = `fitted` says all that `acting` does, 1 = nothing of it.  It is the sine of the angle between what
    /// the one does and the nearest that the other can do.
    double left = 1.0;
};

struct Sensitivity {
    std::vector<Likeness> pairs;        ///< every one of two effects, the likest first
    std::vector<std::string> taken_up;  ///< effects that the base model's own numbers do
    std::vector<std::string> too_weak;  ///< within their ranges they stay below twice the noise
    double response_over_noise = 0.0;   ///< how strong the acting effect was made
};

/// Below it `fitted` cannot be told from `acting`: at five times the noise what is left raises the error by 12 %.
inline constexpr double told_apart = 0.1;

/// The recording is made anew by the engine's own model with each effect of its kind in turn, so strong that it does
/// five times the noise, and every other one is fitted as explain() does.  Options: threads, seed and on_progress.
/// Throws as explain().
Sensitivity sensitivity(const Dataset& data, const ExplainOptions& options = {});

}  // namespace cathlab
