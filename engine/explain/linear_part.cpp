#include "explain/linear_part.h"

#include <Eigen/Cholesky>
#include <cmath>

namespace cathlab {

Eigen::VectorXd solve_linear(const Basis& basis, const std::vector<double>& values, const Split& split) {
    const Eigen::Index n = basis.cols();
    Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(n, n);
    Eigen::VectorXd right = Eigen::VectorXd::Zero(n);
    for (Eigen::Index i = 0; i < basis.rows(); ++i) {
        const double value = values[static_cast<std::size_t>(i)];
        if (split.held_out[static_cast<std::size_t>(i)] != 0 || std::isnan(value)) continue;
        const auto row = basis.row(i);
        normal.selfadjointView<Eigen::Lower>().rankUpdate(row.transpose());
        right.noalias() += value * row.transpose();
    }
    const double scale = normal.trace() / static_cast<double>(n);
    if (!(scale > 0.0)) return Eigen::VectorXd::Zero(n);
    normal.diagonal().array() += 1e-10 * scale;
    return normal.selfadjointView<Eigen::Lower>().ldlt().solve(right);
}

void subtract(const Basis& basis, const Eigen::VectorXd& x, std::vector<double>& values) {
    const Eigen::VectorXd model = basis * x;
    for (std::size_t i = 0; i < values.size(); ++i) values[i] -= model[static_cast<Eigen::Index>(i)];
}

}  // namespace cathlab
