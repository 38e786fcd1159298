// Where a shell comes to rest under loads: Newton's method on its energy, by a sparse factorisation.  Slow and exact
// where the wall's own solver is quick and stepped: for closed forms, calibrations and comparisons with finite
// elements.
#pragma once

#include <Eigen/Sparse>
#include <Eigen/SparseCholesky>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "softbody/shell.h"

namespace cathlab {

/// Adds a load's forces at x (mN) and what they change with x, minus their derivatives (mN/mm; both triangles, positive
/// semi-definite, between particles of one triangle), and returns its potential, uJ.
using ShellLoad = std::function<double(std::span<const Vec3> x, std::span<Vec3> force,
                                       std::vector<Eigen::Triplet<double>>& stiffness)>;

/// A force that stays as it is, one a particle.
ShellLoad dead_load(std::vector<Vec3> force);

/// What one search for rest leaves to the next one of the same shell, held at the same particles: where the matrix has
/// its numbers, and its factors, which are used again while they bring the forces down.
struct ShellFactors {
    Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver;
    Eigen::SparseMatrix<double> matrix;
    std::vector<int>
        place;  ///< of each block of each triangle, its three columns among the matrix's numbers; -1 = none
    bool usable = false;
};

struct ShellRest {
    double force_tolerance_mn = 1e-4;  ///< no free particle feels more
    int most_iterations = 200;
    Fibres fibres = {};
    /// In place of the membrane's own law.  It need not have an energy: the search then follows the work that forces do
    /// on the way.
    ShellLaw law = {};
    ShellFactors* factors = nullptr;  ///< kept from call to call; null = made anew
};

/// Moves x to rest.  fixed: one a particle, 1 = held where x has it.  False where it does not come to rest.
bool shell_equilibrium(const ShellModel& model, std::span<const std::uint8_t> fixed, const ShellLoad& load,
                       std::vector<Vec3>& x, const ShellRest& rest = {});

}  // namespace cathlab
