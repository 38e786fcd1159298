#include "softbody/shell_statics.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>
#include <utility>

#include "core/check.h"

namespace cathlab {

namespace {

constexpr double largest_move_mm = 2.0;  // of a particle in an iteration
constexpr int most_halvings = 25;
constexpr int most_halvings_of_old = 3;  // with factors of another x
constexpr int look_after = 8;            // steps: if factors are still worth keeping
constexpr double worth_keeping = 0.1;    // when they brought the largest force below this part of itself
constexpr std::size_t most_secants = 12;
constexpr double sufficient = 1e-4;  // part of the decrease that the slope promises (Armijo)
constexpr double blurred = 1e-8;     // part of the energy below which a change of it is not trusted
constexpr double against = 0.5;  // of the forces' work along a step at its beginning, that they may do against it at
                                 // its end

/// What a step showed of the true stiffness; the factors' step is made to agree with the last ones of them (the method
/// of Broyden, Fletcher, Goldfarb and Shanno as [matthies1979] uses it).
struct Secant {
    Eigen::VectorXd way, change;  // of the places; of the forces, times -1
    double slope = 0.0;           // way . change, > 0
};

/// The matrix of the free particles: laid out once, filled anew where it stands.
class Matrix {
public:
    Matrix(const ShellModel& model, const std::vector<Eigen::Index>& place, Eigen::Index free, ShellFactors& factors)
        : model_(model), place_(place), free_(free), factors_(factors) {
        if (factors.place.empty()) lay_out();
    }

    /// False where it cannot be factorised.
    bool factorise(std::span<const Vec3> x, const ShellRest& rest,
                   const std::vector<Eigen::Triplet<double>>& load_stiffness) {
        Eigen::SparseMatrix<double>& k = factors_.matrix;
        double* const value = k.valuePtr();
        std::fill(value, value + k.nonZeros(), 0.0);
        std::size_t at = 0;
        const ShellBlocks add = [&](Index i, Index j, const Mat3& block) {
            const int* const column = &factors_.place[at];
            at += 3;
            if (column[0] < 0) return;
            for (int c = 0; c < 3; ++c)
                for (int r = i == j ? c : 0; r < 3; ++r) value[column[c] + r - (i == j ? c : 0)] += block(r, c);
        };
        if (rest.law)
            shell_stiffness_blocks(model_, x, rest.law, add);
        else
            shell_stiffness_blocks(model_, x, rest.fibres, add);
        double diagonal = 0.0;
        for (Eigen::Index i = 0; i < 3 * free_; ++i) diagonal = std::max(diagonal, value[k.outerIndexPtr()[i]]);
        for (const Eigen::Triplet<double>& t : load_stiffness) {
            const Eigen::Index r = unknown(t.row()), c = unknown(t.col());
            if (t.row() < t.col() || r < 0 || c < 0) continue;
            value[find(r, c)] += t.value();
        }
        // A little of the diagonal keeps a slack membrane's matrix definite; it changes the way, not the end.
        for (Eigen::Index i = 0; i < 3 * free_; ++i) value[k.outerIndexPtr()[i]] += 1e-9 * diagonal;
        factors_.solver.factorize(k);
        return factors_.solver.info() == Eigen::Success;
    }

private:
    Eigen::Index unknown(Eigen::Index row) const {
        const Eigen::Index p = place_[static_cast<std::size_t>(row / 3)];
        return p < 0 ? -1 : 3 * p + row % 3;
    }
    std::ptrdiff_t find(Eigen::Index row, Eigen::Index column) const {
        const Eigen::SparseMatrix<double>& k = factors_.matrix;
        const int* const begin = k.innerIndexPtr() + k.outerIndexPtr()[column];
        const int* const end = k.innerIndexPtr() + k.outerIndexPtr()[column + 1];
        const int* const it = std::lower_bound(begin, end, static_cast<int>(row));
        CATHLAB_CHECK(it != end && *it == row, "a load may tie together particles of one triangle alone");
        return it - k.innerIndexPtr();
    }

    void lay_out() {
        std::vector<Eigen::Triplet<double>> entries;
        const auto each = [&](const auto& f) {
            for (const ShellTriangle& t : model_.triangles) {
                for (int j = 0; j < 3; ++j)
                    for (int i = 0; i < 3; ++i)
                        if (t.corner[i] >= t.corner[j]) f(t.corner[i], t.corner[j]);
                for (const Index i : t.patch)
                    for (const Index j : t.patch)
                        if (i >= j) f(i, j);
                for (const Index i : t.height)
                    for (const Index j : t.height)
                        if (j >= 0 && i >= j) f(i, j);
            }
        };
        // Particles keep their order among the unknowns: what is lower there is lower here.
        each([&](Index i, Index j) {
            const Eigen::Index a = place_[static_cast<std::size_t>(i)], b = place_[static_cast<std::size_t>(j)];
            if (a < 0 || b < 0) return;
            for (int c = 0; c < 3; ++c)
                for (int r = a == b ? c : 0; r < 3; ++r)
                    entries.emplace_back(static_cast<int>(3 * a + r), static_cast<int>(3 * b + c), 0.0);
        });
        factors_.matrix.resize(3 * free_, 3 * free_);
        factors_.matrix.setFromTriplets(entries.begin(), entries.end());
        each([&](Index i, Index j) {
            const Eigen::Index a = place_[static_cast<std::size_t>(i)], b = place_[static_cast<std::size_t>(j)];
            for (int c = 0; c < 3; ++c)
                factors_.place.push_back(a < 0 || b < 0 ? -1
                                                        : static_cast<int>(find(3 * a + (a == b ? c : 0), 3 * b + c)));
        });
        factors_.solver.analyzePattern(factors_.matrix);
    }

    const ShellModel& model_;
    const std::vector<Eigen::Index>& place_;
    Eigen::Index free_;
    ShellFactors& factors_;
};

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
    const std::size_t n = model.unknowns();
    CATHLAB_CHECK(fixed.size() == n && x.size() == n, "one place and one mark a particle");
    std::vector<Eigen::Index> place(n, -1);  // of a free particle among the unknowns
    Eigen::Index free = 0;
    for (std::size_t i = 0; i < n; ++i)
        if (!fixed[i]) place[i] = free++;

    std::vector<Vec3> force(n), tried, tried_force;
    std::vector<Eigen::Triplet<double>> load_stiffness;
    ShellFactors own;
    ShellFactors& factors = rest.factors != nullptr ? *rest.factors : own;
    Matrix matrix(model, place, free, factors);
    // The forces at a place, and the energy there where the law has one.
    double energy = 0.0;
    const auto ask = [&](const std::vector<Vec3>& at, bool forces_too) {
        std::fill(force.begin(), force.end(), Vec3::Zero());
        load_stiffness.clear();
        energy = load(at, force, load_stiffness);
        if (!rest.law) energy += shell_energy(model, at, rest.fibres);
        if (!forces_too) return;
        if (rest.law)
            add_shell_forces(model, at, force, rest.law);
        else
            add_shell_forces(model, at, force, rest.fibres);
    };
    const auto residual_of = [&](Eigen::VectorXd& out) {
        double largest = 0.0;
        for (std::size_t i = 0; i < n; ++i) {
            if (place[i] < 0) continue;
            out.segment<3>(3 * place[i]) = force[i];
            largest = std::max(largest, force[i].norm());
        }
        return std::isfinite(out.squaredNorm()) ? largest : std::numeric_limits<double>::infinity();
    };
    const auto go = [&](double share, const Eigen::VectorXd& step) {
        tried = x;
        for (std::size_t i = 0; i < n; ++i)
            if (place[i] >= 0) tried[i] += share * step.segment<3>(3 * place[i]);
    };

    Eigen::VectorXd residual(3 * free), there(3 * free), last_residual, last_step;
    std::deque<Secant> secants;  // since the factors were made
    const auto direction = [&] {
        Eigen::VectorXd q = residual;
        std::vector<double> part(secants.size());
        for (std::size_t k = secants.size(); k-- > 0;) {
            part[k] = secants[k].way.dot(q) / secants[k].slope;
            q -= part[k] * secants[k].change;
        }
        Eigen::VectorXd step = factors.solver.solve(q);
        for (std::size_t k = 0; k < secants.size(); ++k)
            step += (part[k] - secants[k].change.dot(step) / secants[k].slope) * secants[k].way;
        return step;
    };
    ask(x, true);
    bool fresh = false;
    double checked = std::numeric_limits<double>::infinity();  // largest force so many steps ago
    for (int iteration = 0, since = 0; iteration < rest.most_iterations; ++iteration) {
        const double largest = residual_of(residual);
        if (!std::isfinite(largest)) return false;
        if (largest < rest.force_tolerance_mn) return true;
        if (last_step.size() > 0) {
            Secant now{last_step, last_residual - residual, 0.0};
            now.slope = now.way.dot(now.change);
            if (now.slope > 1e-3 * last_residual.dot(last_step)) {
                if (secants.size() == most_secants) secants.pop_front();
                secants.push_back(std::move(now));
            }
        }
        if (++since == look_after) {
            if (largest > worth_keeping * checked) factors.usable = false;
            checked = largest;
            since = 0;
        }
        fresh = !factors.usable;
        if (fresh) {
            secants.clear();
            factors.usable = matrix.factorise(x, rest, load_stiffness);
            if (!factors.usable) return false;
            checked = largest;
            since = 0;
        }
        const Eigen::VectorXd step = direction();
        double far = 0.0;
        for (Eigen::Index i = 0; i < free; ++i) far = std::max(far, step.segment<3>(3 * i).norm());
        double share = std::min(1.0, largest_move_mm / std::max(far, 1e-300));
        const double slope = residual.dot(step), from = energy;
        if (!(slope > 0.0)) {
            if (fresh) return false;
            factors.usable = false;
            last_step.resize(0);
            continue;
        }
        const double rounding = 1e-12 * std::fabs(energy);
        for (int halving = 0;; ++halving) {
            go(share, step);
            ask(tried, static_cast<bool>(rest.law));
            bool good = !rest.law && energy <= from - sufficient * share * slope + rounding;
            if (!good && (rest.law || std::fabs(energy - from) < blurred * std::fabs(from))) {
                // Without an energy, or where its digits end: the forces must not work against the way at its end.
                if (!rest.law) {
                    tried_force = force;
                    add_shell_forces(model, tried, tried_force, rest.fibres);
                    tried_force.swap(force);
                }
                good = std::isfinite(residual_of(there)) && there.dot(step) >= -against * slope;
                if (!rest.law) tried_force.swap(force);
            }
            if (good) break;
            if (halving == (fresh ? most_halvings : most_halvings_of_old)) {
                if (fresh) return false;
                factors.usable = false;  // factors of another x may lead nowhere: stay, and make them anew
                tried = x;
                share = 0.0;
                ask(tried, static_cast<bool>(rest.law));
                break;
            }
            share *= 0.5;
        }
        last_residual = residual;
        last_step = share > 0.0 ? Eigen::VectorXd(share * step) : Eigen::VectorXd();
        x.swap(tried);
        if (!rest.law) add_shell_forces(model, x, force, rest.fibres);
    }
    return false;
}

}  // namespace cathlab
