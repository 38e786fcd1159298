#include <ceres/ceres.h>

#include <algorithm>
#include <cmath>

#include "optimise/least_squares.h"

namespace cathlab {
namespace {

/// One residual block on the unit cube of the free numbers.
class Block final : public ceres::CostFunction {
public:
    Block(const LeastSquaresProblem& problem, std::vector<std::size_t> free, std::vector<double> x, double step)
        : problem_(problem), free_(std::move(free)), x_(std::move(x)), step_(step) {
        set_num_residuals(static_cast<int>(problem.residuals));
        mutable_parameter_block_sizes()->push_back(static_cast<int>(free_.size()));
        moved_.resize(problem.residuals);
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
            if (!call(out)) return false;
            known_.assign(out.begin(), out.end());
            last_ = asked;
        }
        if (jacobians == nullptr || jacobians[0] == nullptr) return true;
        for (std::size_t k = 0; k < free_.size(); ++k) {
            const double h = u[k] + step_ <= 1.0 ? step_ : -step_;  // inwards
            x_[free_[k]] = value(k, u[k] + h);
            if (!call(moved_)) return false;
            x_[free_[k]] = value(k, u[k]);
            for (std::size_t i = 0; i < problem_.residuals; ++i)
                jacobians[0][i * free_.size() + k] = (moved_[i] - residuals[i]) / h;
        }
        return true;
    }

    double value(std::size_t k, double u) const {
        const Bound& b = problem_.bounds[free_[k]];
        return std::clamp(b.lower + u * (b.upper - b.lower), b.lower, b.upper);
    }
    int evaluations() const { return evaluations_; }

private:
    bool call(std::span<double> out) const {
        ++evaluations_;
        if (!problem_.residual(x_, out)) return false;
        return std::all_of(out.begin(), out.end(), [](double r) { return std::isfinite(r); });
    }

    const LeastSquaresProblem& problem_;
    std::vector<std::size_t> free_;
    mutable std::vector<double> x_, moved_;
    mutable std::vector<double> last_, known_;  // asked last, and its residuals; empty = none
    double step_;
    mutable int evaluations_ = 0;
};

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

    auto* block = new Block(problem, free, x, options.step);  // the ceres::Problem owns it
    ceres::Problem solved;
    solved.AddResidualBlock(block, nullptr, u.data());
    for (int k = 0; k < static_cast<int>(free.size()); ++k) {
        solved.SetParameterLowerBound(u.data(), k, 0.0);
        solved.SetParameterUpperBound(u.data(), k, 1.0);
    }
    ceres::Solver::Options how;
    how.max_num_iterations = options.max_iterations;
    how.function_tolerance = options.value_tolerance;
    how.linear_solver_type = ceres::DENSE_NORMAL_CHOLESKY;
    how.logging_type = ceres::SILENT;
    how.num_threads = 1;
    ceres::Solver::Summary summary;
    ceres::Solve(how, &solved, &summary);
    result.evaluations += block->evaluations();
    for (std::size_t k = 0; k < free.size(); ++k) x[free[k]] = block->value(k, u[k]);
    if (problem.residual(x, residual)) {
        const double value = half_square();
        if (value < result.value) {
            result.value = value;
            result.best = x;
        }
    }
    return result;
}

}  // namespace cathlab
