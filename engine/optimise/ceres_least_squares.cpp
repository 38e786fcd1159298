#include <ceres/ceres.h>

#include <algorithm>
#include <atomic>
#include <cmath>

#include "optimise/least_squares.h"

namespace cathlab {
namespace {

/// One residual block on the unit cube of the free numbers.
class Block final : public ceres::CostFunction {
public:
    Block(const LeastSquaresProblem& problem, std::vector<std::size_t> free, std::vector<double> x,
          const LeastSquaresOptions& options)
        : problem_(problem), free_(std::move(free)), x_(std::move(x)), step_(options.step), crew_(options.crew) {
        set_num_residuals(static_cast<int>(problem.residuals));
        mutable_parameter_block_sizes()->push_back(static_cast<int>(free_.size()));
    }

    bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override {
        const double* u = parameters[0];
        for (std::size_t k = 0; k < free_.size(); ++k) x_[free_[k]] = value(k, u[k]);
        const std::span<double> out(residuals, problem_.residuals);
        // A step that was taken is asked again, for its derivatives.
        const std::vector<double> asked(u, u + free_.size());
        if (asked == last_) {
            std::copy(known_.begin(), known_.end(), residuals);
        } else {
            last_.clear();
            ++evaluations_;
            if (!call(x_, out)) return false;
            known_.assign(out.begin(), out.end());
            last_ = asked;
        }
        if (jacobians == nullptr || jacobians[0] == nullptr) return true;
        evaluations_ += static_cast<int>(free_.size());
        std::atomic<bool> good{true};
        crew_.each(free_.size(), [&](std::size_t k) {
            if (!good) return;
            const double h = u[k] + step_ <= 1.0 ? step_ : -step_;  // inwards
            std::vector<double> x = x_, moved(problem_.residuals);
            x[free_[k]] = value(k, u[k] + h);
            if (!call(x, moved)) good = false;
            for (std::size_t i = 0; i < problem_.residuals; ++i)
                jacobians[0][i * free_.size() + k] = (moved[i] - residuals[i]) / h;
        });
        return good;
    }

    double value(std::size_t k, double u) const {
        const Bound& b = problem_.bounds[free_[k]];
        return std::clamp(b.lower + u * (b.upper - b.lower), b.lower, b.upper);
    }
    int evaluations() const { return evaluations_; }

private:
    bool call(std::span<const double> x, std::span<double> out) const {
        if (!problem_.residual(x, out)) return false;
        return std::all_of(out.begin(), out.end(), [](double r) { return std::isfinite(r); });
    }

    const LeastSquaresProblem& problem_;
    std::vector<std::size_t> free_;
    mutable std::vector<double> x_;
    mutable std::vector<double> last_, known_;  // asked last, and its residuals; empty = none
    double step_;
    Crew crew_;
    mutable int evaluations_ = 0;
};

bool on_bound(double u) {
    constexpr double near = 1e-9;
    return u <= near || u >= 1.0 - near;
}

/// Ends a search when a number comes to its bound.  Ceres cuts a step off there and takes what is left of it, which in
/// a valley that goes through the bound leads up its side: the steps shrink until nothing falls any more.
class BoundReached final : public ceres::IterationCallback {
public:
    explicit BoundReached(const std::vector<double>& u) : u_(u) {
        for (const double place : u) were_.push_back(on_bound(place));
    }
    ceres::CallbackReturnType operator()(const ceres::IterationSummary& summary) override {
        if (summary.iteration == 0) return ceres::SOLVER_CONTINUE;
        for (std::size_t k = 0; k < u_.size(); ++k) reached_ = reached_ || (on_bound(u_[k]) && !were_[k]);
        return reached_ ? ceres::SOLVER_TERMINATE_SUCCESSFULLY : ceres::SOLVER_CONTINUE;
    }
    bool reached() const { return reached_; }

private:
    const std::vector<double>& u_;
    std::vector<bool> were_;
    bool reached_ = false;
};

/// Those of the free numbers that stand on a bound, and would fall further beyond it.
std::vector<std::size_t> pushed_out(const Block& block, const std::vector<double>& u, std::size_t residuals) {
    std::vector<std::size_t> out;
    if (std::none_of(u.begin(), u.end(), on_bound)) return out;
    std::vector<double> residual(residuals), slopes(residuals * u.size());
    const double* parameters = u.data();
    double* jacobian = slopes.data();
    if (!block.Evaluate(&parameters, residual.data(), &jacobian)) return out;
    for (std::size_t k = 0; k < u.size(); ++k) {
        if (!on_bound(u[k])) continue;
        double gradient = 0.0;
        for (std::size_t i = 0; i < residuals; ++i) gradient += residual[i] * slopes[i * u.size() + k];
        if (u[k] < 0.5 ? gradient >= 0.0 : gradient <= 0.0) out.push_back(k);
    }
    return out;
}

}  // namespace

Result minimise_squares(const LeastSquaresProblem& problem, const LeastSquaresOptions& options) {
    Problem checked;
    checked.bounds = problem.bounds;
    checked.start = problem.start;
    checked.objective = [](std::span<const double>) { return 0.0; };
    check_problem(checked);

    std::vector<std::size_t> free;
    std::vector<double> x, u;
    for (std::size_t i = 0; i < problem.bounds.size(); ++i) {
        const Bound& b = problem.bounds[i];
        x.push_back(problem.start.empty() ? 0.5 * (b.lower + b.upper) : std::clamp(problem.start[i], b.lower, b.upper));
        if (b.upper <= b.lower) continue;
        free.push_back(i);
        u.push_back(std::clamp((x.back() - b.lower) / (b.upper - b.lower), 0.0, 1.0));
    }
    Result result;
    result.best = x;
    std::vector<double> residual(problem.residuals);
    const auto half_square = [&] {
        double sum = 0.0;
        for (const double r : residual) sum += 0.5 * r * r;
        return sum;
    };
    result.evaluations = 1;
    if (problem.residual(x, residual)) result.value = half_square();
    if (free.empty() || problem.residuals == 0 || !std::isfinite(result.value)) return result;

    // First all numbers together, as far as that goes.  Then what is pushed against its bound is held there while the
    // others go on, until none comes to one or leaves it.
    bool together = true;
    for (int left = options.max_iterations; left > 0; together = false) {
        std::vector<std::size_t> held;
        if (!together) {
            const Block all(problem, free, result.best, options);
            held = pushed_out(all, u, problem.residuals);
            result.evaluations += all.evaluations();
        }
        std::vector<std::size_t> going;  // of the free ones
        std::vector<double> at;
        for (std::size_t k = 0; k < free.size(); ++k) {
            if (std::find(held.begin(), held.end(), k) != held.end()) continue;
            going.push_back(k);
            at.push_back(u[k]);
        }
        if (going.empty()) break;
        std::vector<std::size_t> numbers(going.size());
        std::transform(going.begin(), going.end(), numbers.begin(), [&](std::size_t k) { return free[k]; });
        auto* block = new Block(problem, numbers, result.best, options);  // the ceres::Problem owns it
        ceres::Problem solved;
        solved.AddResidualBlock(block, nullptr, at.data());
        for (int k = 0; k < static_cast<int>(at.size()); ++k) {
            solved.SetParameterLowerBound(at.data(), k, 0.0);
            solved.SetParameterUpperBound(at.data(), k, 1.0);
        }
        BoundReached reached(at);
        ceres::Solver::Options how;
        how.max_num_iterations = left;
        how.function_tolerance = options.value_tolerance;
        how.linear_solver_type = ceres::DENSE_NORMAL_CHOLESKY;
        how.logging_type = ceres::SILENT;
        how.num_threads = 1;
        how.update_state_every_iteration = true;
        if (!together) how.callbacks.push_back(&reached);
        ceres::Solver::Summary summary;
        ceres::Solve(how, &solved, &summary);
        result.evaluations += block->evaluations() + 1;
        if (!together) left -= std::max(1, static_cast<int>(summary.iterations.size()) - 1);
        x = result.best;
        for (std::size_t k = 0; k < going.size(); ++k) x[numbers[k]] = block->value(k, at[k]);
        if (!problem.residual(x, residual)) break;
        const double value = half_square();
        const bool better = value < result.value;
        if (!better && !together) break;
        const bool little = value > (1.0 - options.value_tolerance) * result.value;
        if (better) {
            result.value = value;
            result.best = x;
            for (std::size_t k = 0; k < going.size(); ++k) u[going[k]] = at[k];
        }
        const bool inside = std::none_of(u.begin(), u.end(), on_bound);
        if (together ? inside : !reached.reached() && (little || inside)) break;
    }
    return result;
}

}  // namespace cathlab
