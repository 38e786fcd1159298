#include "softbody/shell.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <string>

#include "core/check.h"
#include "core/deterministic_math.h"
#include "core/errors.h"
#include "softbody/edge_slopes.h"

namespace cathlab {

namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;
using Matrix32 = Eigen::Matrix<double, 3, 2>;
using Matrix23 = Eigen::Matrix<double, 2, 3>;

constexpr double least_det = 1e-12;

std::size_t at(Index i) {
    return static_cast<std::size_t>(i);
}

void check_material(const ShellMaterial& m) {
    const auto refuse = [](const char* what, double found, const char* allowed) {
        throw UserError(std::string("the wall's ") + what + " is " + std::to_string(found) + "; allowed is " + allowed);
    };
    if (!(m.young_kpa > 0.0) || !std::isfinite(m.young_kpa)) refuse("Young's modulus, kPa,", m.young_kpa, "above 0");
    if (!(m.poisson >= 0.0 && m.poisson <= 0.4999)) refuse("Poisson's ratio", m.poisson, "0 to 0.4999");
    if (!(m.thickness_mm > 0.0) || !std::isfinite(m.thickness_mm)) refuse("thickness, mm,", m.thickness_mm, "above 0");
}

Vec3 components(const Matrix2d& c) {
    return {c(0, 0), c(1, 1), c(0, 1)};
}

Matrix2d tensor(const Vec3& s) {
    Matrix2d out;
    out << s[0], s[2], s[2], s[1];
    return out;
}

/// A triangle as it stands.
struct Now {
    Matrix32 gradient;  // F
    Matrix2d c, c_inverse;
    Vec3 normal;
    double determinant = 1.0, thinner = 1.0;  // d, d^-a

    Now(const ShellTriangle& t, std::span<const Vec3> x) {
        Matrix32 edges;
        edges << x[at(t.corner[1])] - x[at(t.corner[0])], x[at(t.corner[2])] - x[at(t.corner[0])];
        gradient = edges * t.rest_inverse;
        c = gradient.transpose() * gradient;
        determinant = std::max(c.determinant(), least_det);
        c_inverse << c(1, 1), -c(0, 1), -c(1, 0), c(0, 0);
        c_inverse /= determinant;
        thinner = det::pow(determinant, -t.thinning);
        normal = gradient.col(0).cross(gradient.col(1));
        normal /= std::max(normal.norm(), 1e-300);
    }
};

/// Of a triangle's fibres, by the energy of their volume.
struct Stretched {
    Matrix2d direction[2];  // H of each family
    FibreTension tension[2];
    double energy_kpa = 0.0;

    Stretched(const ShellTriangle& t, const Fibres& f, const Matrix2d& c) {
        const double cosine = f.cosine(), sine = f.sine();
        for (int k = 0; k < 2; ++k) {
            const double side = k == 0 ? sine : -sine;
            const double along = t.round.x() * cosine - t.round.y() * side,
                         across = t.round.y() * cosine + t.round.x() * side;
            direction[k] << 0.5 + along, across, across, 0.5 - along;
            const double e = direction[k].cwiseProduct(c).sum() - 1.0 - f.onset;
            tension[k] = fibre_tension(f, e);
            energy_kpa += fibre_energy(f, e);
        }
    }
    Matrix2d stress() const { return 2.0 * (tension[0].tension * direction[0] + tension[1].tension * direction[1]); }
};

/// Twice the angle from the first edge to what is across the vessel's direction.
Vector2d round_of(const ShellTriangle& t, std::span<const Vec3> rest, std::span<const Vec3> along) {
    const Vec3 first = (rest[at(t.corner[1])] - rest[at(t.corner[0])]).normalized();
    const Vec3 normal = first.cross(rest[at(t.corner[2])] - rest[at(t.corner[0])]).normalized();
    Vec3 way = along[at(t.corner[0])];  // of either sign
    for (int k = 1; k < 3; ++k)
        way += along[at(t.corner[k])].dot(way) < 0.0 ? -along[at(t.corner[k])] : along[at(t.corner[k])];
    const Vec3 round = normal.cross(way);
    const double x = round.dot(first), y = round.dot(normal.cross(first)), squared = x * x + y * y;
    if (!(squared > 1e-12)) return Vector2d::Zero();
    return Vector2d(x * x - y * y, 2.0 * x * y) / squared;
}

Matrix23 corner_gradients(const ShellTriangle& t) {
    Matrix23 g;  // F = sum over corners of x_c g_c^T
    g.col(1) = t.rest_inverse.row(0).transpose();
    g.col(2) = t.rest_inverse.row(1).transpose();
    g.col(0) = -g.col(1) - g.col(2);
    return g;
}

/// Second derivatives of position: columns 11, 22, 12.
Mat3 second_of(const ShellTriangle& t, std::span<const Vec3> x) {
    Mat3 b = t.held_second;
    const Vec3& origin = x[at(t.patch.front())];  // the weights add up to nothing: only differences count
    for (std::size_t j = 1; j < t.bent; ++j) b += (x[at(t.patch[j])] - origin) * t.second[j].transpose();
    return b;
}

/// How the heights of its corners rise over the triangle.
Vector2d shear_of(const ShellTriangle& t, const Matrix23& gradients, std::span<const Vec3> x) {
    Vector2d rise = Vector2d::Zero();
    for (int c = 0; c < 3; ++c)
        if (t.height[c] >= 0) rise += x[at(t.height[c])].x() * gradients.col(c);
    return rise;
}

/// kappa G t of a section that is sheared, mN/mm.
double shear_stiffness(const ShellTriangle& t) {
    constexpr double part = 5.0 / 6.0;
    return part * t.mu_kpa * t.thickness_mm;
}

/// What bending stores of a triangle as it stands, per area at rest, and how that goes with what it is bent by.
struct Bending {
    Matrix2d raised = Matrix2d::Identity();  // C^-1 where the section is the stretched wall's
    Matrix2d bent, rest, kappa;              // b without what is shear, at rest; what the section is bent by
    bool stretched;
    double thinner = 1.0, a = 0.0, stiff = 0.0;
    double energy = 0.0;  // by kappa
    double pull = 0.0;    // of the membrane's stress on layers that are longer than the middle by the square of b

    Bending(const ShellTriangle& t, const Now& now, const Mat3& second, std::span<const Vec3> x)
        : stretched(t.stretched_section), a(t.thinning), stiff(t.bending_mn_mm * (1.0 - t.poisson)) {
        Vec3 b = second.transpose() * now.normal;
        for (std::size_t j = t.bent; j < t.patch.size(); ++j) b -= x[at(t.patch[j])].x() * t.second[j];
        bent = tensor(b);
        if (stretched) {
            raised = now.c_inverse;
            thinner = std::sqrt(now.thinner);
        }
        rest = tensor(t.rest_curvature);
        kappa = thinner * bent - rest;
        const Matrix2d q = thinner * raised * kappa;
        energy = 0.5 * stiff * (a * q.trace() * q.trace() + (q * q).trace());
        if (!stretched) return;
        const double y = now.thinner;
        const Matrix2d pb = raised * bent;
        pull = 0.25 * stiff *
               (y * (pb * bent).trace() - y * y * (pb * pb).trace() + y * (raised * rest * rest).trace() -
                (rest * rest).trace());
    }
    /// By b, (11, 22, 12).
    Vec3 moment() const {
        Matrix2d m = by_kappa();
        if (stretched) {
            const double y = thinner * thinner;
            const Matrix2d pb = raised * bent;
            m += 0.25 * stiff * y * (pb + pb.transpose() - 2.0 * y * pb * raised);
        }
        return {m(0, 0), m(1, 1), 2.0 * m(0, 1)};
    }
    /// Twice the derivative by C: as a second Piola-Kirchhoff stress times thickness.  Zero for a section at rest.
    Matrix2d by_c() const {
        const Matrix2d pk = raised * kappa, pkp = pk * raised, pb = raised * bent, pbp = pb * raised;
        const double y = thinner * thinner;
        const Matrix2d pr = raised * rest;
        return -2.0 * y * stiff * (a * pk.trace() * pkp + pk * pkp) -
               a * (2.0 * energy + by_kappa().cwiseProduct(bent).sum()) * raised -
               0.5 * stiff * y *
                   (a * ((pb * bent).trace() - 2.0 * y * (pb * pb).trace() + (pr * rest).trace()) * raised +
                    pb * pb.transpose() - 2.0 * y * pb * pbp + pr * pr.transpose());
    }
    /// How raised kappa times thinner changes with b and with C.
    Matrix2d change(const Matrix2d& db, const Matrix2d& dc) const {
        const double thins = -0.5 * a * (raised * dc).trace();
        const Matrix2d turned = dc * raised * kappa;
        return thinner * raised *
               (thinner * db + thinner * thins * bent - 0.5 * (turned + turned.transpose()) + thins * kappa);
    }

private:
    /// As far as it goes by kappa.
    Matrix2d by_kappa() const {
        return thinner * thinner * thinner * stiff * (a * (raised * kappa).trace() * raised + raised * kappa * raised);
    }
};

}  // namespace

ShellModel build_shell(std::span<const Vec3> rest, std::span<const Triangle> triangles,
                       std::span<const ShellMaterial> material, const ShellOptions& options) {
    const std::span<const Vec3> along = options.along;
    CATHLAB_CHECK(along.empty() || along.size() == rest.size(), "one direction a particle");
    CATHLAB_CHECK(material.size() == 1 || material.size() == triangles.size(), "one material, or one a triangle");
    for (const ShellMaterial& m : material) check_material(m);
    ShellModel model;
    model.particles = rest.size();
    for (std::size_t k = 0; k < triangles.size(); ++k) {
        const ShellMaterial& m = material[material.size() == 1 ? 0 : k];
        ShellTriangle t;
        t.corner = triangles[k];
        CATHLAB_CHECK(t.corner.minCoeff() >= 0 && at(t.corner.maxCoeff()) < rest.size(),
                      "a corner that is no particle");
        const Vec3 e1 = rest[at(t.corner[1])] - rest[at(t.corner[0])],
                   e2 = rest[at(t.corner[2])] - rest[at(t.corner[0])];
        t.area_mm2 = 0.5 * e1.cross(e2).norm();
        if (!(t.area_mm2 > 1e-9 * (e1.squaredNorm() + e2.squaredNorm())))
            throw UserError("triangle " + std::to_string(k) + " of the wall has no area: its particles lie in a line");
        const double length = e1.norm();
        Matrix2d edges;
        edges << length, e1.dot(e2) / length, 0.0, 2.0 * t.area_mm2 / length;
        t.rest_inverse = edges.inverse();
        t.thickness_mm = m.thickness_mm;
        t.poisson = m.poisson;
        t.mu_kpa = m.young_kpa / (2.0 * (1.0 + m.poisson));
        t.thinning = m.poisson / (1.0 - m.poisson);
        if (!along.empty()) t.round = round_of(t, rest, along);
        t.bending_mn_mm =
            m.young_kpa * m.thickness_mm * m.thickness_mm * m.thickness_mm / (12.0 * (1.0 - m.poisson * m.poisson));
        t.stretched_section = options.stretched_sections;
        model.triangles.push_back(std::move(t));
    }
    std::vector<SecondDerivatives> second = second_derivatives(rest, triangles, options.held);
    for (std::size_t k = 0; k < triangles.size(); ++k) {
        ShellTriangle& t = model.triangles[k];
        t.patch = std::move(second[k].particle);
        t.bent = t.patch.size();
        t.second = std::move(second[k].weight);
        t.held_second = second[k].held;
        t.rest_curvature = second_of(t, rest).transpose() * Now(t, rest).normal;
    }
    return model;
}

void give_shear(ShellModel& model, std::span<const std::uint8_t> where) {
    CATHLAB_CHECK(where.size() == model.particles && model.heights == 0, "one mark a particle, given once");
    std::vector<Index> height(model.particles, -1);
    for (std::size_t i = 0; i < where.size(); ++i)
        if (where[i] != 0) height[i] = static_cast<Index>(model.unknowns()), ++model.heights;
    for (ShellTriangle& t : model.triangles) {
        for (std::size_t j = 0; j < t.bent; ++j) {
            if (height[at(t.patch[j])] < 0) continue;
            t.patch.push_back(height[at(t.patch[j])]);
            t.second.push_back(t.second[j]);
        }
        for (int c = 0; c < 3; ++c) t.height[c] = height[at(t.corner[c])];
    }
}

namespace {

void add_membrane_force(const ShellTriangle& t, const Now& now, const Matrix2d& stress, std::span<Vec3> force) {
    const Mat3 on_corner = -t.area_mm2 * t.thickness_mm * now.gradient * stress * corner_gradients(t);
    for (int c = 0; c < 3; ++c) force[at(t.corner[c])] += on_corner.col(c);
}

void add_bending_force(const ShellTriangle& t, const Now& now, std::span<const Vec3> x, std::span<Vec3> force) {
    const Matrix23 g = corner_gradients(t);
    const Mat3 b = second_of(t, x);
    const Bending bending(t, now, b, x);
    const Vec3 moment = t.area_mm2 * bending.moment();
    // The normal turns with the triangle: dn = - sum over g of (n . da_g) a^g.
    const Vector2d turned = (now.gradient * now.c_inverse).transpose() * (b * moment);
    for (int c = 0; c < 3; ++c) force[at(t.corner[c])] += g.col(c).dot(turned) * now.normal;
    if (t.stretched_section) {
        const Mat3 drawn = -t.area_mm2 * now.gradient * bending.by_c() * g;
        for (int c = 0; c < 3; ++c) force[at(t.corner[c])] += drawn.col(c);
    }
    for (std::size_t j = 0; j < t.bent; ++j) force[at(t.patch[j])] -= t.second[j].dot(moment) * now.normal;
    for (std::size_t j = t.bent; j < t.patch.size(); ++j) force[at(t.patch[j])].x() += t.second[j].dot(moment);
    if (t.bent == t.patch.size()) return;
    const Vector2d rise = t.area_mm2 * shear_stiffness(t) * shear_of(t, g, x);
    for (int c = 0; c < 3; ++c)
        if (t.height[c] >= 0) force[at(t.height[c])].x() -= g.col(c).dot(rise);
}

/// slope(dC) = dS.
template <class Slope, class Add>
void add_stiffness(const ShellTriangle& t, const Now& now, std::span<const Vec3> x, const Matrix2d& stress,
                   const Slope& slope, const Add& add) {
    const Eigen::SelfAdjointEigenSolver<Matrix2d> axes(stress);
    const Matrix2d pulled =
        axes.eigenvectors() * axes.eigenvalues().cwiseMax(0.0).asDiagonal() * axes.eigenvectors().transpose();
    const Matrix23 g = corner_gradients(t);
    const double size = t.area_mm2 * t.thickness_mm;
    for (int j = 0; j < 3; ++j) {
        std::array<Mat3, 3> block;
        for (int axis = 0; axis < 3; ++axis) {
            Matrix32 change = Matrix32::Zero();
            change.row(axis) = g.col(j).transpose();
            const Matrix2d dc = change.transpose() * now.gradient + now.gradient.transpose() * change;
            const Mat3 column = size * (change * pulled + now.gradient * slope(dc)) * g;  // one column a corner
            for (int i = 0; i < 3; ++i) block[static_cast<std::size_t>(i)].col(axis) = column.col(i);
        }
        for (int i = 0; i < 3; ++i) add(t.corner[i], t.corner[j], block[static_cast<std::size_t>(i)]);
    }
    const Bending bending(t, now, second_of(t, x), x);
    // A particle bends it along the normal, a height by what it takes away.
    std::vector<std::array<Matrix2d, 3>> change(t.patch.size());  // of what the section is bent by, an axis
    for (std::size_t j = 0; j < t.patch.size(); ++j)
        for (int axis = 0; axis < 3; ++axis) {
            const double along = j < t.bent ? now.normal[axis] : (axis == 0 ? -1.0 : 0.0);
            Matrix2d dc = Matrix2d::Zero();
            if (j < 3 && t.stretched_section) {
                dc = now.gradient.row(axis).transpose() * g.col(static_cast<Eigen::Index>(j)).transpose();
                dc += dc.transpose().eval();
            }
            change[j][static_cast<std::size_t>(axis)] = bending.change(along * tensor(t.second[j]), dc);
        }
    for (std::size_t i = 0; i < t.patch.size(); ++i)
        for (std::size_t j = 0; j < t.patch.size(); ++j) {
            if (t.patch[i] < t.patch[j]) continue;
            Mat3 block;
            for (int r = 0; r < 3; ++r)
                for (int c = 0; c < 3; ++c) {
                    const Matrix2d &by_i = change[i][static_cast<std::size_t>(r)],
                                   &by_j = change[j][static_cast<std::size_t>(c)];
                    block(r, c) = t.area_mm2 * bending.stiff *
                                  (bending.a * by_i.trace() * by_j.trace() + by_i.cwiseProduct(by_j.transpose()).sum());
                }
            add(t.patch[i], t.patch[j], block);
        }
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
            if (t.height[i] >= 0 && t.height[j] >= 0) {
                Mat3 block = Mat3::Zero();
                block(0, 0) = t.area_mm2 * shear_stiffness(t) * g.col(i).dot(g.col(j));
                add(t.height[i], t.height[j], block);
            }
}

template <class Add>
void each_block(const ShellModel& model, std::span<const Vec3> x, const Fibres& fibres, const Add& add) {
    for (const ShellTriangle& t : model.triangles) {
        const Now now(t, x);
        const double y = now.thinner;
        const Stretched fibre(t, fibres, now.c);
        Matrix2d stress = t.mu_kpa * (Matrix2d::Identity() - y * now.c_inverse);
        if (fibres.any()) stress += fibre.stress();
        const auto slope = [&](const Matrix2d& dc) {
            Matrix2d ds =
                t.mu_kpa * y *
                (t.thinning * (now.c_inverse * dc).trace() * now.c_inverse + now.c_inverse * dc * now.c_inverse);
            for (int k = 0; fibres.any() && k < 2; ++k)
                ds += 2.0 * fibre.tension[k].slope * fibre.direction[k].cwiseProduct(dc).sum() * fibre.direction[k];
            return ds;
        };
        add_stiffness(t, now, x, stress, slope, add);
    }
}

}  // namespace

Eigen::Matrix2d shell_strain(const ShellTriangle& triangle, std::span<const Vec3> x) {
    return 0.5 * (Now(triangle, x).c - Matrix2d::Identity());
}

double shell_energy(const ShellModel& model, std::span<const Vec3> x, const Fibres& fibres) {
    double energy = 0.0;
    for (const ShellTriangle& t : model.triangles) {
        const Now now(t, x);
        const double thinned = t.thinning > 0.0 ? (now.thinner - 1.0) / t.thinning : -det::log(now.determinant);
        double membrane = 0.5 * t.mu_kpa * (now.c.trace() - 2.0 + thinned);
        if (fibres.any()) membrane += Stretched(t, fibres, now.c).energy_kpa;
        const Bending bending(t, now, second_of(t, x), x);
        energy += t.area_mm2 * (t.thickness_mm * membrane + bending.energy + bending.pull);
        if (t.bent < t.patch.size())
            energy += 0.5 * t.area_mm2 * shear_stiffness(t) * shear_of(t, corner_gradients(t), x).squaredNorm();
    }
    return energy;
}

void add_shell_forces(const ShellModel& model, std::span<const Vec3> x, std::span<Vec3> force, const Fibres& fibres) {
    CATHLAB_CHECK(x.size() >= model.unknowns() && force.size() >= model.unknowns(),
                  "one place and one force a particle");
    for (const ShellTriangle& t : model.triangles) {
        const Now now(t, x);
        Matrix2d stress = t.mu_kpa * (Matrix2d::Identity() - now.thinner * now.c_inverse);
        if (fibres.any()) stress += Stretched(t, fibres, now.c).stress();
        add_membrane_force(t, now, stress, force);
        add_bending_force(t, now, x, force);
    }
}

void add_shell_forces(const ShellModel& model, std::span<const Vec3> x, std::span<Vec3> force, const ShellLaw& law) {
    for (std::size_t k = 0; k < model.triangles.size(); ++k) {
        const ShellTriangle& t = model.triangles[k];
        const Now now(t, x);
        add_membrane_force(t, now, tensor(law(k, components(now.c))), force);
        add_bending_force(t, now, x, force);
    }
}

Eigen::SparseMatrix<double> shell_stiffness(const ShellModel& model, std::span<const Vec3> x, const Fibres& fibres) {
    std::vector<Eigen::Triplet<double>> entries;
    each_block(model, x, fibres, [&](Index i, Index j, const Mat3& block) {
        if (i < j) return;
        for (int r = 0; r < 3; ++r)
            for (int c = 0; c < 3; ++c)
                if (i > j || r >= c)
                    entries.emplace_back(static_cast<int>(3 * i + r), static_cast<int>(3 * j + c), block(r, c));
    });
    const auto n = static_cast<Eigen::Index>(3 * model.unknowns());
    Eigen::SparseMatrix<double> k(n, n);
    k.setFromTriplets(entries.begin(), entries.end());
    return k;
}

void shell_stiffness_blocks(const ShellModel& model, std::span<const Vec3> x, const Fibres& fibres,
                            const ShellBlocks& add) {
    each_block(model, x, fibres, [&](Index i, Index j, const Mat3& block) {
        if (i >= j) add(i, j, block);
    });
}

void shell_stiffness_blocks(const ShellModel& model, std::span<const Vec3> x, const ShellLaw& law,
                            const ShellBlocks& add) {
    constexpr double difference = 1e-6;
    constexpr double trace = 1e-3;  // of mu
    for (std::size_t k = 0; k < model.triangles.size(); ++k) {
        const ShellTriangle& t = model.triangles[k];
        const Now now(t, x);
        const Vec3 c = components(now.c), stress = law(k, c);
        Mat3 slope;  // of S by E 11, 22, 2 E12
        for (int axis = 0; axis < 3; ++axis) {
            Vec3 moved = c;
            moved[axis] += difference;
            slope.col(axis) = (law(k, moved) - stress) * ((axis < 2 ? 2.0 : 1.0) / difference);
        }
        const Eigen::SelfAdjointEigenSolver<Mat3> axes(0.5 * (slope + slope.transpose()));
        const Mat3 definite = axes.eigenvectors() * axes.eigenvalues().cwiseMax(trace * t.mu_kpa).asDiagonal() *
                              axes.eigenvectors().transpose();
        add_stiffness(
            t, now, x, tensor(stress),
            [&](const Matrix2d& dc) { return tensor(definite * Vec3(0.5 * dc(0, 0), 0.5 * dc(1, 1), dc(0, 1))); },
            [&](Index i, Index j, const Mat3& block) {
                if (i >= j) add(i, j, block);
            });
    }
}

}  // namespace cathlab
