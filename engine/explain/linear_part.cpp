#include "explain/linear_part.h"

#include <cmath>

namespace cathlab {

LinearPart::LinearPart(Basis basis, std::vector<std::uint8_t> known)
    : basis_(std::move(basis)), known_(std::move(known)) {
    const Eigen::Index n = basis_.cols();
    Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(n, n);
    for (Eigen::Index i = 0; i < basis_.rows(); ++i)
        if (known_[static_cast<std::size_t>(i)] != 0)
            normal.selfadjointView<Eigen::Lower>().rankUpdate(basis_.row(i).transpose());
    const double scale = normal.trace() / static_cast<double>(n);
    empty_ = !(scale > 0.0);
    if (empty_) return;
    normal.diagonal().array() += 1e-10 * scale;
    const Eigen::MatrixXd whole = normal.selfadjointView<Eigen::Lower>();
    factored_.compute(whole);
}

Eigen::VectorXd LinearPart::solve(const std::vector<double>& values) const {
    Eigen::VectorXd right = Eigen::VectorXd::Zero(basis_.cols());
    if (empty_) return right;
    for (Eigen::Index i = 0; i < basis_.rows(); ++i)
        if (known_[static_cast<std::size_t>(i)] != 0)
            right.noalias() += values[static_cast<std::size_t>(i)] * basis_.row(i).transpose();
    return factored_.solve(right);
}

Eigen::VectorXd solve_linear(const Basis& basis, const std::vector<double>& values, const Split& split) {
    std::vector<std::uint8_t> known;
    for (std::size_t i = 0; i < values.size(); ++i)
        known.push_back(split.held_out[i] == 0 && !std::isnan(values[i]) ? 1 : 0);
    return LinearPart(basis, std::move(known)).solve(values);
}

void subtract(const Basis& basis, const Eigen::VectorXd& x, std::vector<double>& values) {
    const Eigen::VectorXd model = basis * x;
    for (std::size_t i = 0; i < values.size(); ++i) values[i] -= model[static_cast<Eigen::Index>(i)];
}

}  // namespace cathlab
