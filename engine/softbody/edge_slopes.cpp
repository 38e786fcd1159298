#include "softbody/edge_slopes.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <map>
#include <utility>

#include "core/check.h"

namespace cathlab {

namespace {

using Eigen::Vector2d;

// What a slope's particles say of less than this part of what they say best is not asked of them.
constexpr double least_singular = 0.05;

std::size_t at(Eigen::Index i) {
    return static_cast<std::size_t>(i);
}

/// A triangle and one of its edges: from corner `edge` to the next.
struct EdgeOf {
    Index triangle = -1;  // none
    int edge = -1;
};

Index opposite(std::span<const Triangle> triangles, const EdgeOf& e) {
    return triangles[at(e.triangle)][(e.edge + 2) % 3];
}

/// What lies across each edge of each triangle.
using Across = std::vector<std::array<EdgeOf, 3>>;

Across across_edges(std::span<const Triangle> triangles) {
    Across across(triangles.size());
    std::map<std::pair<Index, Index>, EdgeOf> open;
    for (std::size_t t = 0; t < triangles.size(); ++t)
        for (int k = 0; k < 3; ++k) {
            const Index a = triangles[t][k], b = triangles[t][(k + 1) % 3];
            const EdgeOf here{static_cast<Index>(t), k};
            const auto other = open.find({b, a});
            if (other == open.end()) {
                CATHLAB_CHECK(open.emplace(std::pair{a, b}, here).second,
                              "an edge of the wall's triangles is shared by more than two of them");
                continue;
            }
            CATHLAB_CHECK(opposite(triangles, here) != opposite(triangles, other->second),
                          "two of the wall's triangles have the same corners");
            across[t][at(k)] = other->second;
            across[at(other->second.triangle)][at(other->second.edge)] = here;
            open.erase(other);
        }
    return across;
}

/// A triangle and what is around it, unfolded into its plane: distances along the wall stay what they are.
class Patch {
public:
    Patch(std::span<const Vec3> rest, std::span<const Triangle> triangles, const Across& across, std::size_t centre)
        : rest_(rest), triangles_(triangles), across_(across) {
        const Triangle& t = triangles[centre];
        const Vec3 e1 = rest[at(t[1])] - rest[at(t[0])], e2 = rest[at(t[2])] - rest[at(t[0])];
        const double length = e1.norm(), along = e1.dot(e2) / length;
        place(t[0], Vector2d(0, 0));
        place(t[1], Vector2d(length, 0));
        place(t[2], Vector2d(along, e1.cross(e2).norm() / length));
        last_.push_back({static_cast<Index>(centre), -1});
    }
    /// Adds the triangles across the edges of those that came last.
    void grow() {
        std::vector<EdgeOf> reached;
        for (const EdgeOf& by : last_)
            for (int k = 0; k < 3; ++k) {
                const EdgeOf next = across_[at(by.triangle)][at(k)];
                if (k == by.edge || next.triangle < 0) continue;
                const Triangle& here = triangles_[at(by.triangle)];
                unfold(here[k], here[(k + 1) % 3], opposite(triangles_, next));
                reached.push_back(next);
            }
        last_ = std::move(reached);
    }
    const std::vector<Index>& particles() const { return particle_; }
    const Vector2d& place_of(Index particle) const { return place_[find(particle)]; }

private:
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
    const Across& across_;
    std::vector<Index> particle_;
    std::vector<Vector2d> place_;
    std::vector<EdgeOf> last_;  // by their edges towards the middle
};

/// How position changes across an edge, at its middle, by weights on particles; outward as `triangle` has it.
struct EdgeSlope {
    std::size_t triangle = 0;
    std::vector<std::pair<Index, double>> weight;  // 1/mm
    Vec3 held = Vec3::Zero();                      // ... or a direction that stays
};

/// Slopes across all edges: three a triangle, the two triangles of an edge have one in common.
class EdgeSlopes {
public:
    EdgeSlopes(std::span<const Vec3> rest, std::span<const Triangle> triangles, std::span<const std::uint8_t> held)
        : rest_(rest), triangles_(triangles), held_(held), across_(across_edges(triangles)), number_(triangles.size()) {
        for (std::size_t t = 0; t < triangles.size(); ++t)
            for (int k = 0; k < 3; ++k) {
                const EdgeOf other = across_[t][at(k)];
                if (other.triangle >= 0 && at(other.triangle) < t) continue;
                const auto number = static_cast<Index>(slope_.size());
                number_[t][k] = number;
                if (other.triangle >= 0) number_[at(other.triangle)][other.edge] = number;
                slope_.push_back(slope(t, k));
            }
    }
    const EdgeSlope& of(std::size_t triangle, int edge) const { return slope_[at(number_[triangle][edge])]; }

private:
    /// The edge's ends, what lies opposite in its triangles, and what lies beside those; at an open edge, all there is.
    std::vector<Index> asked(std::size_t triangle, int k, const Patch& patch) const {
        const Triangle& t = triangles_[triangle];
        std::vector<Index> out{t[k], t[(k + 1) % 3], t[(k + 2) % 3]}, more;
        const EdgeOf other = across_[triangle][at(k)];
        if (other.triangle >= 0) {
            out.push_back(opposite(triangles_, other));
            for (const EdgeOf& side : {EdgeOf{static_cast<Index>(triangle), k}, other})
                for (int next = 1; next < 3; ++next) {
                    const EdgeOf beside = across_[at(side.triangle)][at((side.edge + next) % 3)];
                    if (beside.triangle >= 0) more.push_back(opposite(triangles_, beside));
                }
        } else {
            more = patch.particles();
        }
        for (const Index p : more)
            if (std::find(out.begin(), out.end(), p) == out.end()) out.push_back(p);
        return out;
    }

    EdgeSlope slope(std::size_t triangle, int k) const {
        EdgeSlope out;
        out.triangle = triangle;
        const Triangle& t = triangles_[triangle];
        const Index a = t[k], b = t[(k + 1) % 3], c = t[(k + 2) % 3];
        const bool open = across_[triangle][at(k)].triangle < 0;
        if (open && !held_.empty() && held_[at(a)] != 0 && held_[at(b)] != 0) {
            const Vec3 along = (rest_[at(b)] - rest_[at(a)]).normalized(), off = rest_[at(c)] - rest_[at(a)];
            out.held = -(off - off.dot(along) * along).normalized();
            return out;
        }
        Patch patch(rest_, triangles_, across_, triangle);
        patch.grow();
        patch.grow();
        const std::vector<Index> particles = asked(triangle, k, patch);
        // From the edge's middle outward and along it, in lengths of it.
        const Vector2d from = patch.place_of(a), to = patch.place_of(b), middle = 0.5 * (from + to);
        const double length = (to - from).norm();
        const Vector2d along = (to - from) / length, out_of(along.y(), -along.x());
        const auto n = static_cast<Eigen::Index>(particles.size());
        Eigen::MatrixXd linear(n, 3), quadratic(n, 3);
        for (Eigen::Index j = 0; j < n; ++j) {
            const Vector2d off = (patch.place_of(particles[static_cast<std::size_t>(j)]) - middle) / length;
            const double s = off.dot(out_of), u = off.dot(along);
            linear.row(j) << 1.0, s, u;
            quadratic.row(j) << 0.5 * s * s, s * u, 0.5 * u * u;
        }
        // Of what is linear on each of the two triangles, weighed so that a bend about the edge is seen truly ...
        Eigen::VectorXd weight = Eigen::VectorXd::Zero(n);
        const double depth = -linear(2, 1), beyond = open ? 0.0 : linear(3, 1);
        const auto add = [&](Eigen::Index corner, double share) {
            weight[corner] += share;
            weight[0] -= share * (0.5 - linear(corner, 2));
            weight[1] -= share * (0.5 + linear(corner, 2));
        };
        add(2, -(open ? 1.0 : beyond / (depth + beyond)) / depth);
        if (!open) add(3, depth / (depth + beyond) / beyond);
        // ... and so little more that every quadratic is; linear fields stay as they are.
        const Eigen::MatrixXd kept =
            Eigen::MatrixXd::Identity(n, n) - linear * (linear.transpose() * linear).inverse() * linear.transpose();
        Eigen::JacobiSVD<Eigen::MatrixXd> svd((kept * quadratic).transpose(),
                                              Eigen::ComputeThinU | Eigen::ComputeThinV);
        svd.setThreshold(least_singular);
        weight -= svd.solve(quadratic.transpose() * weight);
        for (Eigen::Index j = 0; j < n; ++j)
            out.weight.emplace_back(particles[static_cast<std::size_t>(j)], weight[j] / length);
        return out;
    }

    std::span<const Vec3> rest_;
    std::span<const Triangle> triangles_;
    std::span<const std::uint8_t> held_;
    Across across_;
    std::vector<Triangle> number_;  // (triangles) of the slope across each edge
    std::vector<EdgeSlope> slope_;
};

/// By the slopes across a triangle's edges (Gauss).
SecondDerivatives derivatives_of(std::span<const Vec3> rest, const Triangle& t, const EdgeSlopes& slopes,
                                 std::size_t number) {
    SecondDerivatives out;
    const auto add = [&](Index particle, const Vec3& weight) {
        const auto found = std::find(out.particle.begin(), out.particle.end(), particle);
        if (found != out.particle.end()) {
            out.weight[static_cast<std::size_t>(found - out.particle.begin())] += weight;
        } else {
            out.particle.push_back(particle);
            out.weight.push_back(weight);
        }
    };
    for (const Index corner : t) add(corner, Vec3::Zero());
    const Vec3 e1 = rest[at(t[1])] - rest[at(t[0])], e2 = rest[at(t[2])] - rest[at(t[0])], up = e1.cross(e2);
    const Vec3 first = e1.normalized(), second = up.cross(e1).normalized();
    const double area = 0.5 * up.norm();
    for (int k = 0; k < 3; ++k) {
        const Index a = t[k], b = t[(k + 1) % 3];
        const Vec3 edge = rest[at(b)] - rest[at(a)];
        const double length = edge.norm();
        const Vector2d along(edge.dot(first) / length, edge.dot(second) / length), out_of(along.y(), -along.x());
        const Vec3 across =
            length / area * Vec3(out_of.x() * out_of.x(), out_of.y() * out_of.y(), out_of.x() * out_of.y());
        const Vec3 twist = length / area *
                           Vec3(out_of.x() * along.x(), out_of.y() * along.y(),
                                0.5 * (out_of.x() * along.y() + out_of.y() * along.x()));
        add(a, -twist / length);
        add(b, twist / length);
        const EdgeSlope& slope = slopes.of(number, k);
        const double side = slope.triangle == number ? 1.0 : -1.0;
        for (const auto& [particle, weight] : slope.weight) add(particle, side * weight * across);
        out.held += slope.held * across.transpose();
    }
    return out;
}

}  // namespace

std::vector<SecondDerivatives> second_derivatives(std::span<const Vec3> rest, std::span<const Triangle> triangles,
                                                  std::span<const std::uint8_t> held) {
    CATHLAB_CHECK(held.empty() || held.size() == rest.size(), "one mark a particle");
    const EdgeSlopes slopes(rest, triangles, held);
    std::vector<SecondDerivatives> out;
    out.reserve(triangles.size());
    for (std::size_t k = 0; k < triangles.size(); ++k) out.push_back(derivatives_of(rest, triangles[k], slopes, k));
    return out;
}

}  // namespace cathlab
