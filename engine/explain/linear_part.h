// The part of a model that is linear in its free numbers: fitted exactly whenever anything else is tried beside it.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "explain/dataset.h"
#include "explain/split.h"

namespace cathlab {

using Basis = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;  ///< (rows x numbers)

/// The least squares of columns with the same known rows, factored once.
class LinearPart {
public:
    /// known: rows that the fit may use.
    LinearPart(Basis basis, std::vector<std::uint8_t> known);
    Eigen::VectorXd solve(const std::vector<double>& values) const;
    const Basis& basis() const { return basis_; }

private:
    Basis basis_;
    std::vector<std::uint8_t> known_;
    Eigen::LDLT<Eigen::MatrixXd> factored_;
    bool empty_ = false;
};

/// The least squares of one column on the rows that the fit sees, with a trace of ridge: a run without such rows keeps
/// the number 0 and does not spoil the others.  Rows where `values` is NaN are left out.
Eigen::VectorXd solve_linear(const Basis& basis, const std::vector<double>& values, const Split& split);

/// values <- values - basis x.
void subtract(const Basis& basis, const Eigen::VectorXd& x, std::vector<double>& values);

}  // namespace cathlab
