#include <algorithm>
#include <cmath>
#include <exception>
#include <nlopt.hpp>

#include "core/errors.h"
#include "optimise/local.h"

namespace cathlab {
namespace {

/// The problem on the unit cube of its free numbers.
class UnitCube {
public:
    UnitCube(const Problem& problem, const LocalOptions& options) : problem_(problem), options_(options) {
        for (std::size_t i = 0; i < problem.bounds.size(); ++i) {
            const Bound& b = problem.bounds[i];
            x_.push_back(problem.start.empty() ? 0.5 * (b.lower + b.upper)
                                               : std::clamp(problem.start[i], b.lower, b.upper));
            if (b.upper > b.lower) free_.push_back(i);
        }
    }

    std::vector<double> start() const {
        std::vector<double> u;
        for (const std::size_t i : free_) {
            const Bound& b = problem_.bounds[i];
            u.push_back(std::clamp((x_[i] - b.lower) / (b.upper - b.lower), 0.0, 1.0));
        }
        return u;
    }

    double evaluate(const std::vector<double>& u) {
        for (std::size_t k = 0; k < free_.size(); ++k) {
            const Bound& b = problem_.bounds[free_[k]];
            x_[free_[k]] = std::clamp(b.lower + u[k] * (b.upper - b.lower), b.lower, b.upper);
        }
        const double value = problem_.objective(x_);
        ++result.evaluations;
        if (std::isfinite(value)) {
            largest_ = std::max(largest_, std::fabs(value));
            if (value < result.value) {
                result.value = value;
                result.best = x_;
            }
        }
        if (result.best.empty()) result.best = x_;
        if (options_.on_evaluation && !options_.on_evaluation({0, 0, result.evaluations, result.value, result.best})) {
            result.stopped = true;
            throw nlopt::forced_stop();
        }
        // A quadratic model through an infinity is no model: a wall somewhat higher than all that was seen serves.
        return std::isfinite(value) ? value : 10.0 * largest_ + 1.0;
    }

    /// nlopt calls this; what the objective throws is carried round the C code and thrown again by the caller.
    static double call(const std::vector<double>& u, std::vector<double>&, void* self) {
        auto& cube = *static_cast<UnitCube*>(self);
        try {
            return cube.evaluate(u);
        } catch (const nlopt::forced_stop&) {
            throw;
        } catch (...) {
            cube.thrown = std::current_exception();
            throw nlopt::forced_stop();
        }
    }

    std::size_t free_count() const { return free_.size(); }

    Result result;
    std::exception_ptr thrown;

private:
    const Problem& problem_;
    const LocalOptions& options_;
    std::vector<std::size_t> free_;
    std::vector<double> x_;
    double largest_ = 0.0;
};

}  // namespace

Result minimise_local(const Problem& problem, const LocalOptions& options) {
    check_problem(problem);
    if (options.max_evaluations < 1) throw UserError("local search: max_evaluations must be 1 or more");
    if (!(options.first_step > 0.0 && options.first_step <= 0.5))
        throw UserError("local search: first_step = " + std::to_string(options.first_step) +
                        "; allowed: above 0 to 0.5");
    UnitCube cube(problem, options);
    std::vector<double> u = cube.start();
    const auto n = static_cast<unsigned>(cube.free_count());
    const bool quadratic = options.method == LocalMethod::bobyqa && n >= 2;
    try {
        if (n == 0) {
            cube.evaluate(u);
            return cube.result;
        }
        nlopt::opt search(quadratic ? nlopt::LN_BOBYQA : nlopt::LN_SBPLX, n);
        search.set_lower_bounds(0.0);
        search.set_upper_bounds(1.0);
        search.set_min_objective(&UnitCube::call, &cube);
        search.set_maxeval(options.max_evaluations);
        search.set_xtol_abs(options.x_tolerance);
        search.set_ftol_rel(options.value_tolerance);
        search.set_initial_step(options.first_step);
        double value = 0.0;
        search.optimize(u, value);
    } catch (const nlopt::forced_stop&) {
        if (cube.thrown) std::rethrow_exception(cube.thrown);
    } catch (const nlopt::roundoff_limited&) {
        // no smaller step changes the value: the best stands
    }
    return cube.result;
}

}  // namespace cathlab
