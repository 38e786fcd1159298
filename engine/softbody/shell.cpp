#include "softbody/shell.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include "core/check.h"
#include "core/deterministic_math.h"
#include "core/errors.h"

namespace cathlab {

namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;
using Matrix32 = Eigen::Matrix<double, 3, 2>;
using Matrix23 = Eigen::Matrix<double, 2, 3>;

// A patch whose weights are larger than this, in units of 1 / (twice the triangle's area), is too near a conic for a
// quadratic through its six points: the next ring joins it.
constexpr double largest_weight = 6.0;
// Directions in which a patch at an open edge says next to nothing about curvature are left out.
constexpr double least_singular = 0.05;
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

/// Which triangle lies across each edge.
class Neighbours {
public:
    explicit Neighbours(std::span<const Triangle> triangles)
        : triangles_(triangles), across_(triangles.size(), Triangle(-1, -1, -1)) {
        std::map<std::pair<Index, Index>, std::pair<std::size_t, int>> open;
        for (std::size_t t = 0; t < triangles.size(); ++t)
            for (int k = 0; k < 3; ++k) {
                const Index a = triangles[t][k], b = triangles[t][(k + 1) % 3];
                const auto other = open.find({b, a});
                if (other == open.end()) {
                    CATHLAB_CHECK(open.emplace(std::pair{a, b}, std::pair{t, k}).second,
                                  "an edge of the wall's triangles is shared by more than two of them");
                    continue;
                }
                across_[t][k] = static_cast<Index>(other->second.first);
                across_[other->second.first][other->second.second] = static_cast<Index>(t);
                open.erase(other);
            }
    }
    Index across(std::size_t triangle, int edge) const { return across_[triangle][edge]; }

private:
    std::span<const Triangle> triangles_;
    std::vector<Triangle> across_;
};

/// A triangle and what is around it, unfolded into its plane: distances along the wall stay what they are.
class Patch {
public:
    Patch(std::span<const Vec3> rest, std::span<const Triangle> triangles, const Neighbours& neighbours,
          std::size_t centre)
        : rest_(rest), triangles_(triangles), neighbours_(neighbours) {
        const Triangle& t = triangles[centre];
        const Vec3 e1 = rest[at(t[1])] - rest[at(t[0])], e2 = rest[at(t[2])] - rest[at(t[0])];
        const double length = e1.norm(), along = e1.dot(e2) / length;
        place(t[0], Vector2d(0, 0));
        place(t[1], Vector2d(length, 0));
        place(t[2], Vector2d(along, e1.cross(e2).norm() / length));
        edge_.push_back({centre, -1});
    }
    /// Adds the triangles across the edges of those that came last.
    void grow() {
        std::vector<Reached> reached;
        for (const Reached& r : edge_) {
            for (int k = 0; k < 3; ++k) {
                if (k == r.entered) continue;
                const Index next = neighbours_.across(r.triangle, k);
                if (next < 0) continue;
                const Triangle& here = triangles_[r.triangle];
                const Triangle& there = triangles_[at(next)];
                int entered = 0;
                while (there[entered] != here[(k + 1) % 3] || there[(entered + 1) % 3] != here[k]) ++entered;
                unfold(here[k], here[(k + 1) % 3], there[(entered + 2) % 3]);
                reached.push_back({at(next), entered});
            }
        }
        edge_ = std::move(reached);
    }
    const std::vector<Index>& particles() const { return particle_; }
    const std::vector<Vector2d>& places() const { return place_; }

private:
    struct Reached {
        std::size_t triangle;
        int entered;  // its edge towards the patch's middle
    };
    std::size_t find(Index particle) const {
        return static_cast<std::size_t>(std::find(particle_.begin(), particle_.end(), particle) - particle_.begin());
    }
    void place(Index particle, const Vector2d& where) {
        particle_.push_back(particle);
        place_.push_back(where);
    }
    // a to b is the edge as the inner triangle has it; `far` lies on its right.
    void unfold(Index a, Index b, Index far) {
        if (find(far) < particle_.size()) return;
        const Vector2d pa = place_[find(a)], pb = place_[find(b)];
        const Vector2d d = (pb - pa).normalized();
        const Vec3 axis = (rest_[at(b)] - rest_[at(a)]).normalized(), off = rest_[at(far)] - rest_[at(a)];
        const double along = off.dot(axis), aside = (off - along * axis).norm();
        place(far, pa + along * d + aside * Vector2d(d.y(), -d.x()));
    }

    std::span<const Vec3> rest_;
    std::span<const Triangle> triangles_;
    const Neighbours& neighbours_;
    std::vector<Index> particle_;
    std::vector<Vector2d> place_;
    std::vector<Reached> edge_;
};

/// Weights of second derivatives (N x 3: 11, 22, 12): a quadratic fitted to what a linear field leaves.  They give 0
/// for linear fields exactly, whatever the patch.
Eigen::MatrixXd second_derivatives(const std::vector<Vector2d>& places, double scale) {
    const auto n = static_cast<Eigen::Index>(places.size());
    Vector2d middle = Vector2d::Zero();
    for (const Vector2d& p : places) middle += p / static_cast<double>(n);
    Eigen::MatrixXd linear(n, 3), quadratic(n, 3);
    for (Eigen::Index i = 0; i < n; ++i) {
        const Vector2d p = (places[static_cast<std::size_t>(i)] - middle) / scale;
        linear.row(i) << 1.0, p.x(), p.y();
        quadratic.row(i) << 0.5 * p.x() * p.x(), 0.5 * p.y() * p.y(), p.x() * p.y();
    }
    const Eigen::MatrixXd kept =
        Eigen::MatrixXd::Identity(n, n) - linear * (linear.transpose() * linear).inverse() * linear.transpose();
    Eigen::JacobiSVD<Eigen::MatrixXd> svd(kept * quadratic, Eigen::ComputeThinU | Eigen::ComputeThinV);
    svd.setThreshold(least_singular);
    return (svd.solve(kept) / (scale * scale)).transpose();
}

void set_bending(ShellTriangle& triangle, std::span<const Vec3> rest, std::span<const Triangle> triangles,
                 const Neighbours& neighbours, std::size_t centre) {
    Patch patch(rest, triangles, neighbours, centre);
    const double scale = std::sqrt(2.0 * triangle.area_mm2);
    patch.grow();
    Eigen::MatrixXd weights = second_derivatives(patch.places(), scale);
    if (patch.particles().size() < 6 || weights.cwiseAbs().maxCoeff() * scale * scale > largest_weight) {
        patch.grow();
        weights = second_derivatives(patch.places(), scale);
    }
    triangle.patch = patch.particles();
    for (Eigen::Index j = 0; j < weights.rows(); ++j) triangle.second.emplace_back(weights.row(j));
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
    Mat3 b = Mat3::Zero();
    const Vec3& origin = x[at(t.patch.front())];  // the weights add up to nothing: only differences count
    for (std::size_t j = 1; j < t.patch.size(); ++j) b += (x[at(t.patch[j])] - origin) * t.second[j].transpose();
    return b;
}

/// Of the energy per area, by (kappa 11, 22, 12).
Mat3 bending_matrix(const ShellTriangle& t) {
    Mat3 d;
    d << 1.0, t.poisson, 0.0, t.poisson, 1.0, 0.0, 0.0, 0.0, 2.0 * (1.0 - t.poisson);
    return t.bending_mn_mm * d;
}

}  // namespace

ShellModel build_shell(std::span<const Vec3> rest, std::span<const Triangle> triangles,
                       std::span<const ShellMaterial> material, std::span<const Vec3> along) {
    CATHLAB_CHECK(along.empty() || along.size() == rest.size(), "one direction a particle");
    CATHLAB_CHECK(material.size() == 1 || material.size() == triangles.size(), "one material, or one a triangle");
    for (const ShellMaterial& m : material) check_material(m);
    const Neighbours neighbours(triangles);
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
        set_bending(t, rest, triangles, neighbours, k);
        t.rest_curvature = second_of(t, rest).transpose() * Now(t, rest).normal;
        model.triangles.push_back(std::move(t));
    }
    return model;
}

namespace {

void add_membrane_force(const ShellTriangle& t, const Now& now, const Matrix2d& stress, std::span<Vec3> force) {
    const Mat3 on_corner = -t.area_mm2 * t.thickness_mm * now.gradient * stress * corner_gradients(t);
    for (int c = 0; c < 3; ++c) force[at(t.corner[c])] += on_corner.col(c);
}

void add_bending_force(const ShellTriangle& t, const Now& now, std::span<const Vec3> x, std::span<Vec3> force) {
    const Matrix23 g = corner_gradients(t);
    const Mat3 b = second_of(t, x);
    const Vec3 moment = t.area_mm2 * (bending_matrix(t) * (b.transpose() * now.normal - t.rest_curvature));
    // The normal turns with the triangle: dn = - sum over g of (n . da_g) a^g.
    const Vector2d turned = (now.gradient * now.c_inverse).transpose() * (b * moment);
    for (int c = 0; c < 3; ++c) force[at(t.corner[c])] += g.col(c).dot(turned) * now.normal;
    for (std::size_t j = 0; j < t.patch.size(); ++j) force[at(t.patch[j])] -= t.second[j].dot(moment) * now.normal;
}

/// slope(dC) = dS.
template <class Slope, class Add>
void add_stiffness(const ShellTriangle& t, const Now& now, const Matrix2d& stress, const Slope& slope, const Add& add) {
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
    const Mat3 bending = t.area_mm2 * bending_matrix(t);
    const Mat3 across = now.normal * now.normal.transpose();
    for (std::size_t i = 0; i < t.patch.size(); ++i)
        for (std::size_t j = 0; j < t.patch.size(); ++j)
            add(t.patch[i], t.patch[j], t.second[i].dot(bending * t.second[j]) * across);
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
        add_stiffness(t, now, stress, slope, add);
    }
}

Vec3 components(const Matrix2d& c) {
    return {c(0, 0), c(1, 1), c(0, 1)};
}

Matrix2d tensor(const Vec3& s) {
    Matrix2d out;
    out << s[0], s[2], s[2], s[1];
    return out;
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
        const Vec3 kappa = second_of(t, x).transpose() * now.normal - t.rest_curvature;
        energy += t.area_mm2 * (t.thickness_mm * membrane + 0.5 * kappa.dot(bending_matrix(t) * kappa));
    }
    return energy;
}

void add_shell_forces(const ShellModel& model, std::span<const Vec3> x, std::span<Vec3> force, const Fibres& fibres) {
    CATHLAB_CHECK(x.size() >= model.particles && force.size() >= model.particles, "one place and one force a particle");
    for (const ShellTriangle& t : model.triangles) {
        const Now now(t, x);
        Matrix2d stress = t.mu_kpa * (Matrix2d::Identity() - now.thinner * now.c_inverse);
        if (fibres.any()) stress += Stretched(t, fibres, now.c).stress();
        const Matrix23 g = corner_gradients(t);
        const Mat3 on_corner = -t.area_mm2 * t.thickness_mm * now.gradient * stress * g;
        const Mat3 b = second_of(t, x);
        const Vec3 moment = t.area_mm2 * (bending_matrix(t) * (b.transpose() * now.normal - t.rest_curvature));
        // The normal turns with the triangle: dn = - sum over g of (n . da_g) a^g.
        const Vector2d turned = (now.gradient * now.c_inverse).transpose() * (b * moment);
        for (int c = 0; c < 3; ++c) force[at(t.corner[c])] += on_corner.col(c) + g.col(c).dot(turned) * now.normal;
        for (std::size_t j = 0; j < t.patch.size(); ++j) force[at(t.patch[j])] -= t.second[j].dot(moment) * now.normal;
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
    const auto n = static_cast<Eigen::Index>(3 * model.particles);
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
            t, now, tensor(stress),
            [&](const Matrix2d& dc) { return tensor(definite * Vec3(0.5 * dc(0, 0), 0.5 * dc(1, 1), dc(0, 1))); },
            [&](Index i, Index j, const Mat3& block) {
                if (i >= j) add(i, j, block);
            });
    }
}

}  // namespace cathlab
