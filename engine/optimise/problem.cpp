#include "optimise/problem.h"

#include <cmath>

#include "core/check.h"
#include "core/errors.h"

namespace cathlab {
namespace {

void check_bound(const Bound& bound, std::size_t i) {
    const std::string name = bound.name.empty() ? "parameter " + std::to_string(i + 1) : "'" + bound.name + "'";
    const std::string range = std::to_string(bound.lower) + " to " + std::to_string(bound.upper);
    if (!std::isfinite(bound.lower) || !std::isfinite(bound.upper))
        throw UserError(name + ": the range " + range + " must be finite");
    if (bound.lower > bound.upper) throw UserError(name + ": the range " + range + " is turned round");
}

}  // namespace

void check_problem(const Problem& problem) {
    CATHLAB_CHECK(static_cast<bool>(problem.objective), "a problem needs an objective");
    if (problem.bounds.empty()) throw UserError("there is nothing to optimise: no parameter was named");
    for (std::size_t i = 0; i < problem.bounds.size(); ++i) check_bound(problem.bounds[i], i);
    if (!problem.start.empty() && problem.start.size() != problem.bounds.size())
        throw UserError("the start has " + std::to_string(problem.start.size()) + " numbers for " +
                        std::to_string(problem.bounds.size()) + " parameters");
}

}  // namespace cathlab
