#include "softbody/shell_statics.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/check.h"

namespace cathlab {

namespace {

constexpr double largest_move_mm = 2.0;  // of a particle in an iteration
constexpr int most_halvings = 25;
constexpr int most_halvings_of_old = 3;  // with factors of another x
constexpr double worth_keeping = 0.3;    // factors that brought the largest force below this part of itself
constexpr double sufficient = 1e-4;      // part of the decrease that the slope promises (Armijo)

/// W = 1/2 S : (C - 1) of each triangle's volume.
double stress_energy(const ShellModel& model, std::span<const Vec3> stress, std::span<const Vec3> x) {
    double energy = 0.0;
    for (std::size_t k = 0; k < stress.size(); ++k) {
        const ShellTriangle& t = model.triangles[k];
        const Eigen::Matrix2d e = shell_strain(t, x);
        energy += t.area_mm2 * t.thickness_mm *
                  (stress[k][0] * e(0, 0) + stress[k][1] * e(1, 1) + 2.0 * stress[k][2] * e(0, 1));
    }
    return energy;
}

void add_stress_forces(const ShellModel& model, std::span<const Vec3> stress, std::span<const Vec3> x,
                       std::vector<Vec3>& force) {
    for (std::size_t k = 0; k < stress.size(); ++k) {
        const ShellTriangle& t = model.triangles[k];
        const auto place = [&](int corner) { return x[static_cast<std::size_t>(t.corner[corner])]; };
        Eigen::Matrix<double, 3, 2> edges;
        edges << place(1) - place(0), place(2) - place(0);
        Eigen::Matrix2d s;
        s << stress[k][0], stress[k][2], stress[k][2], stress[k][1];
        const Eigen::Matrix<double, 3, 2> pull =
            t.area_mm2 * t.thickness_mm * edges * t.rest_inverse * s * t.rest_inverse.transpose();
        force[static_cast<std::size_t>(t.corner[1])] -= pull.col(0);
        force[static_cast<std::size_t>(t.corner[2])] -= pull.col(1);
        force[static_cast<std::size_t>(t.corner[0])] += pull.col(0) + pull.col(1);
    }
}

}  // namespace

ShellLoad dead_load(std::vector<Vec3> force) {
    return
        [load = std::move(force)](std::span<const Vec3> x, std::span<Vec3> out, std::vector<Eigen::Triplet<double>>&) {
            double potential = 0.0;
            for (std::size_t i = 0; i < load.size(); ++i) {
                out[i] += load[i];
                potential -= load[i].dot(x[i]);
            }
            return potential;
        };
}

bool shell_equilibrium(const ShellModel& model, std::span<const std::uint8_t> fixed, const ShellLoad& load,
                       std::vector<Vec3>& x, const ShellRest& rest) {
    const std::size_t n = model.particles;
    CATHLAB_CHECK(fixed.size() == n && x.size() == n, "one place and one mark a particle");
    std::vector<Eigen::Index> place(n, -1);  // of a free particle among the unknowns
    Eigen::Index free = 0;
    for (std::size_t i = 0; i < n; ++i)
        if (!fixed[i]) place[i] = free++;
    const auto unknown = [&](Eigen::Index row) { return place[static_cast<std::size_t>(row / 3)]; };

    std::vector<Vec3> force(n), tried;
    std::vector<Eigen::Triplet<double>> load_stiffness, entries;
    const auto energy_at = [&](const std::vector<Vec3>& at, std::vector<Vec3>& on) {
        std::fill(on.begin(), on.end(), Vec3::Zero());
        load_stiffness.clear();
        return shell_energy(model, at, rest.fibres) + stress_energy(model, rest.more_stress, at) +
               load(at, on, load_stiffness);
    };
    ShellFactors own;
    ShellFactors& factors = rest.factors != nullptr ? *rest.factors : own;
    Eigen::SparseMatrix<double> k(3 * free, 3 * free);
    bool fresh = false;  // the factors are of this x
    double energy = energy_at(x, force), before = factors.usable ? std::numeric_limits<double>::infinity() : 0.0;
    for (int iteration = 0; iteration < rest.most_iterations; ++iteration) {
        add_shell_forces(model, x, force, rest.fibres);
        add_stress_forces(model, rest.more_stress, x, force);
        Eigen::VectorXd residual(3 * free);
        double largest = 0.0;
        for (std::size_t i = 0; i < n; ++i) {
            if (place[i] < 0) continue;
            residual.segment<3>(3 * place[i]) = force[i];
            largest = std::max(largest, force[i].norm());
        }
        if (!std::isfinite(largest)) return false;
        if (largest < rest.force_tolerance_mn) return true;

        // Factors serve again while they bring the forces down: what they lack is mostly what they never had.
        fresh = largest > worth_keeping * before || !factors.usable;
        if (fresh) {
            entries.clear();
            const auto add = [&](Eigen::Index r, Eigen::Index c, double value) {
                if (unknown(r) < 0 || unknown(c) < 0) return;
                entries.emplace_back(static_cast<int>(3 * unknown(r) + r % 3), static_cast<int>(3 * unknown(c) + c % 3),
                                     value);
            };
            const Eigen::SparseMatrix<double> shell = shell_stiffness(model, x, rest.fibres);
            double diagonal = 0.0;
            for (Eigen::Index c = 0; c < shell.outerSize(); ++c)
                for (Eigen::SparseMatrix<double>::InnerIterator it(shell, c); it; ++it) {
                    add(it.row(), it.col(), it.value());
                    if (it.row() == it.col()) diagonal = std::max(diagonal, it.value());
                }
            for (const Eigen::Triplet<double>& t : load_stiffness)
                if (t.row() >= t.col()) add(t.row(), t.col(), t.value());
            // A little of the diagonal keeps a slack membrane's matrix definite; it changes the way, not the end.
            for (Eigen::Index i = 0; i < 3 * free; ++i)
                entries.emplace_back(static_cast<int>(i), static_cast<int>(i), 1e-9 * diagonal);
            k.setFromTriplets(entries.begin(), entries.end());
            const std::span<const int> rows(k.innerIndexPtr(), static_cast<std::size_t>(k.nonZeros()));
            if (!std::equal(rows.begin(), rows.end(), factors.pattern.begin(), factors.pattern.end())) {
                factors.solver.analyzePattern(k);
                factors.pattern.assign(rows.begin(), rows.end());
            }
            factors.solver.factorize(k);
            factors.usable = factors.solver.info() == Eigen::Success;
            if (!factors.usable) return false;
        }
        before = largest;
        const Eigen::VectorXd step = factors.solver.solve(residual);
        double far = 0.0;
        for (Eigen::Index i = 0; i < free; ++i) far = std::max(far, step.segment<3>(3 * i).norm());
        double share = std::min(1.0, largest_move_mm / std::max(far, 1e-300));
        const double slope = residual.dot(step);
        const double rounding = 1e-12 * std::fabs(energy);
        for (int halving = 0;; ++halving) {
            tried = x;
            for (std::size_t i = 0; i < n; ++i)
                if (place[i] >= 0) tried[i] += share * step.segment<3>(3 * place[i]);
            const double lower = energy_at(tried, force);
            if (lower <= energy - sufficient * share * slope + rounding) {
                energy = lower;
                break;
            }
            if (halving == (fresh ? most_halvings : most_halvings_of_old)) {
                if (fresh) return false;
                factors.usable = false;  // factors of another x may lead nowhere: stay, and make them anew
                tried = x;
                energy = energy_at(x, force);
                break;
            }
            share *= 0.5;
        }
        x.swap(tried);
    }
    return false;
}

}  // namespace cathlab
