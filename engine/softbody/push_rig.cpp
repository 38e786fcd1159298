#include "softbody/push_rig.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <string>

#include "core/check.h"
#include "core/errors.h"
#include "softbody/shell_statics.h"
#include "softbody/tube.h"
#include "softbody/wall_sample.h"

namespace cathlab {

namespace {

constexpr int parts = 5;                  // a triangle's edge is cut into so many for the contact's points
constexpr double mesh_per_spacing = 0.4;  // edges of the fine surface, of the particles' spacing
constexpr double growth = 0.3;            // of the spacing, a mm away from where the wall is looked at
constexpr double force_tolerance_mn = 1e-2;
constexpr int marker_rounds = 50;

std::size_t at(Index i) {
    return static_cast<std::size_t>(i);
}

double longest_edge(const TriMesh& mesh) {
    double longest = 0.0;
    for (const Triangle& t : mesh.triangles)
        for (int k = 0; k < 3; ++k)
            longest = std::max(longest, (mesh.vertices[at(t[(k + 1) % 3])] - mesh.vertices[at(t[k])]).norm());
    return longest;
}

/// Each triangle cut into four at the middles of its edges.
TriMesh cut_in_four(const TriMesh& mesh) {
    TriMesh out;
    out.vertices = mesh.vertices;
    std::map<std::pair<Index, Index>, Index> middle;
    const auto between = [&](Index a, Index b) {
        const auto [place, fresh] = middle.try_emplace(std::minmax(a, b), static_cast<Index>(out.vertices.size()));
        if (fresh) out.vertices.emplace_back(0.5 * (mesh.vertices[at(a)] + mesh.vertices[at(b)]));
        return place->second;
    };
    for (const Triangle& t : mesh.triangles) {
        const Index ab = between(t[0], t[1]), bc = between(t[1], t[2]), ca = between(t[2], t[0]);
        out.triangles.insert(out.triangles.end(), {Triangle(t[0], ab, ca), Triangle(ab, t[1], bc),
                                                   Triangle(ca, bc, t[2]), Triangle(ab, bc, ca)});
    }
    return out;
}

/// Weights of the middles of parts^2 equal parts of a triangle.
std::vector<Vec3> contact_points() {
    std::vector<Vec3> out;
    for (int i = 0; i < parts; ++i)
        for (int j = 0; j < parts - i; ++j)
            for (const double third : {1.0, 2.0}) {
                if (third > 1.5 && j == parts - i - 1) continue;
                const double a = (i + third / 3.0) / parts, b = (j + third / 3.0) / parts;
                out.emplace_back(1.0 - a - b, a, b);
            }
    return out;
}

/// The ball's push: potential, forces, stiffness; `total` is its force on the wall.
class Ball {
public:
    Ball(const ShellModel& shell, const Vec3& centre, double radius, double near, double young_kpa, double thickness_mm)
        : shell_(shell),
          centre_(centre),
          radius_(radius),
          near_(near),
          young_kpa_(young_kpa),
          thickness_mm_(thickness_mm),
          points_(contact_points()) {}

    double operator()(std::span<const Vec3> x, std::span<Vec3> force, std::vector<Eigen::Triplet<double>>& stiffness,
                      Vec3& total) const {
        double potential = 0.0;
        total.setZero();
        for (const ShellTriangle& t : shell_.triangles) {
            std::array<Vec3, 3> corner;
            for (int k = 0; k < 3; ++k) corner[static_cast<std::size_t>(k)] = x[at(t.corner[k])];
            if ((corner[0] - centre_).norm() > radius_ + near_) continue;
            const double area = t.area_mm2 / static_cast<double>(points_.size());
            std::array<Mat3, 6> block;  // corners 0 0, 1 0, 1 1, 2 0, 2 1, 2 2
            bool touched = false;
            const Vec3 outward = (corner[1] - corner[0]).cross(corner[2] - corner[0]);
            for (const Vec3& w : points_) {
                const Vec3 off = w[0] * corner[0] + w[1] * corner[1] + w[2] * corner[2] - centre_;
                if (!(off.squaredNorm() < radius_ * radius_)) continue;
                // A point that went past the centre is pushed back over it, not on.
                const double side = off.dot(outward) < 0.0 ? -1.0 : 1.0;
                const double distance = side * off.norm();
                if (distance == 0.0) continue;
                const Pressed bed = pressed(radius_ - distance);
                const Vec3 normal = off / distance, push = area * bed.pressure_kpa * normal;
                potential += area * bed.energy_kpa_mm;
                total += push;
                if (!touched) block.fill(Mat3::Zero());
                touched = true;
                const Mat3 stiff = area * bed.slope_kpa_per_mm * normal * normal.transpose();
                for (int i = 0, at_block = 0; i < 3; ++i) {
                    force[at(t.corner[i])] += w[i] * push;
                    for (int j = 0; j <= i; ++j, ++at_block)
                        block[static_cast<std::size_t>(at_block)] += w[i] * w[j] * stiff;
                }
            }
            if (!touched) continue;
            for (int i = 0; i < 3; ++i)
                for (int j = 0; j < 3; ++j)
                    for (int r = 0; r < 3; ++r)
                        for (int c = 0; c < 3; ++c)
                            stiffness.emplace_back(
                                static_cast<int>(3 * t.corner[i] + r), static_cast<int>(3 * t.corner[j] + c),
                                block[static_cast<std::size_t>(std::max(i, j) * (std::max(i, j) + 1) / 2 +
                                                               std::min(i, j))](r, c));
        }
        return potential;
    }

    /// Whether the ball's centre is on the inner side of the wall that is nearest to it.
    bool inside(std::span<const Vec3> x) const {
        double nearest = radius_;
        bool out = true;
        for (const ShellTriangle& t : shell_.triangles) {
            std::array<Vec3, 3> corner;
            for (int k = 0; k < 3; ++k) corner[static_cast<std::size_t>(k)] = x[at(t.corner[k])];
            if ((corner[0] - centre_).norm() > radius_ + near_) continue;
            const Vec3 normal = (corner[1] - corner[0]).cross(corner[2] - corner[0]);
            for (const Vec3& w : points_) {
                const Vec3 off = w[0] * corner[0] + w[1] * corner[1] + w[2] * corner[2] - centre_;
                if (off.norm() >= nearest) continue;
                nearest = off.norm();
                out = off.dot(normal) > 0.0;
            }
        }
        return out;
    }

private:
    struct Pressed {
        double pressure_kpa = 0.0, slope_kpa_per_mm = 0.0, energy_kpa_mm = 0.0;
    };
    /// The bed pressed by a depth > 0: what is left of its thickness is l of it,
    ///     p = E/3 (l^-2 - l),   l = 1 - depth / t,
    /// a neo-Hookean bar's; on in a straight line where less than least_left is left.
    Pressed pressed(double depth) const {
        constexpr double least_left = 0.2;
        const double e = young_kpa_ / 3.0, l = std::max(1.0 - depth / thickness_mm_, least_left);
        const double beyond = depth - (1.0 - l) * thickness_mm_;
        Pressed out;
        out.slope_kpa_per_mm = e / thickness_mm_ * (2.0 / (l * l * l) + 1.0);
        const double at_l = e * (1.0 / (l * l) - l);
        out.pressure_kpa = at_l + out.slope_kpa_per_mm * beyond;
        out.energy_kpa_mm = e * thickness_mm_ * (1.0 / l - 1.0 - 0.5 * (1.0 - l * l)) +
                            beyond * (at_l + 0.5 * out.slope_kpa_per_mm * beyond);
        return out;
    }

    const ShellModel& shell_;
    Vec3 centre_;
    double radius_, near_, young_kpa_, thickness_mm_;
    std::vector<Vec3> points_;
};

/// A point that rides on a triangle: by its weights on the corners, and a height along their normals.
class Marker {
public:
    Marker(const ShellModel& shell, std::span<const Vec3> rest, const Vec3& place) : shell_(shell) {
        double nearest = std::numeric_limits<double>::infinity();
        for (std::size_t k = 0; k < shell.triangles.size(); ++k) {
            Vec3 middle = Vec3::Zero();
            for (int c = 0; c < 3; ++c) middle += rest[at(shell.triangles[k].corner[c])] / 3.0;
            const double distance = (middle - place).norm();
            if (distance >= nearest) continue;
            nearest = distance;
            triangle_ = k;
        }
        // Newton on (weight of corner 1, of corner 2, height).
        const std::vector<Vec3> normal = normals(rest);
        for (int round = 0; round < marker_rounds; ++round) {
            constexpr double d = 1e-6;
            const Vec3 here = place_of(rest, normal, local_);
            Mat3 slope;
            for (int k = 0; k < 3; ++k) {
                Vec3 moved = local_;
                moved[k] += d;
                slope.col(k) = (place_of(rest, normal, moved) - here) / d;
            }
            local_ += slope.inverse() * (place - here);
        }
    }
    Vec3 place(std::span<const Vec3> x) const { return place_of(x, normals(x), local_); }

private:
    std::vector<Vec3> normals(std::span<const Vec3> x) const {
        std::vector<Vec3> normal(x.size(), Vec3::Zero());
        for (const ShellTriangle& t : shell_.triangles) {
            const Vec3 area = (x[at(t.corner[1])] - x[at(t.corner[0])]).cross(x[at(t.corner[2])] - x[at(t.corner[0])]);
            for (int k = 0; k < 3; ++k) normal[at(t.corner[k])] += area;
        }
        for (Vec3& n : normal) n.normalize();
        return normal;
    }
    Vec3 place_of(std::span<const Vec3> x, const std::vector<Vec3>& normal, const Vec3& local) const {
        const Triangle& corner = shell_.triangles[triangle_].corner;
        const Vec3 weight(1.0 - local[0] - local[1], local[0], local[1]);
        Vec3 point = Vec3::Zero(), up = Vec3::Zero();
        for (int k = 0; k < 3; ++k) {
            point += weight[k] * x[at(corner[k])];
            up += weight[k] * normal[at(corner[k])];
        }
        return point + local[2] * up.normalized();
    }

    const ShellModel& shell_;
    std::size_t triangle_ = 0;
    Vec3 local_ = Vec3(1.0 / 3.0, 1.0 / 3.0, 0.0);
};

void require_above_zero(const char* what, double value) {
    if (!(value > 0.0) || !std::isfinite(value))
        throw UserError(std::string(what) + " is " + std::to_string(value) + "; above 0 is wanted");
}

}  // namespace

TriMesh straight_lumen(double radius_mm, double length_mm, double spacing_mm) {
    require_above_zero("the tube's radius, mm,", radius_mm);
    require_above_zero("the tube's length, mm,", length_mm);
    require_above_zero("the particle spacing, mm,", spacing_mm);
    TubeShape shape;
    shape.radius_mm = radius_mm;
    shape.length_mm = length_mm;
    shape.edge_mm = mesh_per_spacing * spacing_mm;
    shape.closed = false;
    return tube_mesh(shape);
}

PushedWall::PushedWall(const PushRig& rig)
    : ball_radius_mm_(rig.ball_radius_mm + 0.5 * rig.thickness_mm),
      spacing_mm_(rig.particle_spacing_mm),
      young_kpa_(rig.young_kpa) {
    require_above_zero("the wall's thickness, mm,", rig.thickness_mm);
    require_above_zero("the ball's radius, mm,", rig.ball_radius_mm);
    require_above_zero("the particle spacing, mm,", rig.particle_spacing_mm);
    if (rig.lumen.empty()) throw UserError("the vessel's surface has no triangles");
    TriMesh middle = rig.lumen;
    const std::vector<Vec3> normal = vertex_normals(middle);
    for (std::size_t v = 0; v < normal.size(); ++v) middle.vertices[v] += 0.5 * rig.thickness_mm * normal[v];
    while (longest_edge(middle) > 1.5 * mesh_per_spacing * rig.particle_spacing_mm) middle = cut_in_four(middle);

    const auto spacing_at = [&](const Vec3& p) {
        if (rig.looked_at.empty()) return rig.particle_spacing_mm;
        double nearest = std::numeric_limits<double>::infinity();
        for (const Vec3& place : rig.looked_at) nearest = std::min(nearest, (p - place).norm());
        const double beyond = std::max(0.0, nearest - ball_radius_mm_ - 2.0 * rig.particle_spacing_mm);
        return std::min(rig.particle_spacing_mm + growth * beyond,
                        std::max(rig.far_spacing_mm, rig.particle_spacing_mm));
    };
    std::vector<double> spacing;
    for (const Vec3& v : middle.vertices) spacing.push_back(spacing_at(v));
    const WallSample sample = sample_wall(middle, std::vector<Index>(middle.vertices.size(), 0), spacing,
                                          std::vector<double>{rig.thickness_mm}, rig.seed);
    rest_ = sample.position;
    area_mm2_ = sample.area_mm2;
    thickness_mm_ = rig.thickness_mm;
    // Particles are sparse: those of the last row stand for the ring itself.
    for (const Vec3& p : rest_)
        fixed_.push_back(std::any_of(rig.held.begin(), rig.held.end(), [&](const HeldDisc& disc) {
            const double reach = 0.6 * spacing_at(p);
            const Vec3 off = p - disc.center;
            return std::fabs(off.dot(disc.normal)) <= disc.half_thickness_mm + reach &&
                   off.norm() <= disc.radius_mm + reach;
        }));
    if (std::count(fixed_.begin(), fixed_.end(), 1) < 3)
        throw UserError("the wall is held nowhere: no three particles lie within the discs of [[setup.fixed]]");
    const ShellMaterial material{rig.young_kpa, rig.poisson, rig.thickness_mm};
    shell_ = build_shell(rest_, sample.triangles, {&material, 1});
    const Eigen::SparseMatrix<double> k = shell_stiffness(shell_, rest_);
    holding_.assign(rest_.size(), 0.0);
    for (std::size_t i = 0; i < rest_.size(); ++i)
        for (int axis = 0; fixed_[i] && axis < 3; ++axis)
            holding_[i] = std::max(
                holding_[i], k.coeff(static_cast<Eigen::Index>(3 * i) + axis, static_cast<Eigen::Index>(3 * i) + axis));
}

PushResult PushedWall::push(const Push& push, const std::function<bool()>& go_on) const {
    return this->push(push, PushedLaw{}, go_on);
}

/// One place of the ball: the wall at rest there, with what effects make of it.
class PushedWall::Sample {
public:
    Sample(const PushedWall& wall, const PushedLaw& law) : wall_(wall), law_(law) {
        slipped_.assign(wall.rest_.size(), Vec3::Zero());
        rest_.force_tolerance_mn = force_tolerance_mn;
        rest_.most_iterations = most_iterations;
        rest_.fibres = law.fibres;
        rest_.factors = &factors_;
        if (law.membrane) rest_.most_iterations = most_with_a_law;
        if (law.membrane)
            rest_.law = [this](std::size_t k, const Vec3& c) {
                MembranePoint point = point_of(k, c);
                law_.membrane(material_of(k), point);
                return point.stress;
            };
    }

    /// Searches use these, or their own where there are none.
    void use(ShellFactors* factors) { rest_.factors = factors != nullptr ? factors : &factors_; }

    /// The way of particle i, from a guess: held ones go along as far as they slip.
    void go(std::size_t i, const Vec3& way, std::vector<Vec3>& x) {
        if (!wall_.fixed_[i]) {
            x[i] += way;
        } else if (law_.slip) {
            slipped_[i] += way;
            x[i] = wall_.rest_[i] + slipped_[i];
        }
    }

    /// As settle(); where that finds no rest, the ball takes the way from `before` in small parts.
    bool solve(const Vec3& before, const Vec3& centre, const std::vector<Vec3>& from, std::vector<Vec3>& x,
               Vec3& total) {
        bool found = settle(centre, x, total);
        for (int tries = 0, count = 4; !found && tries < 2; ++tries, count *= 4) {
            x = from;
            for (std::size_t i = 0; i < x.size(); ++i)
                if (wall_.fixed_[i]) slipped_[i] = x[i] - wall_.rest_[i];
            rest_.factors->usable = false;
            found = true;
            for (int k = 1; k <= count && found; ++k)
                found = settle(before + (centre - before) * (static_cast<double>(k) / count), x, total);
        }
        if (found) keep(x);
        return found;
    }

private:
    static constexpr int most_rounds = 12;
    static constexpr int most_iterations = 200, most_with_a_law = 60;
    static constexpr double still_mm = 4e-3;

    /// Moves x to rest; total: the ball's force.
    bool settle(const Vec3& centre, std::vector<Vec3>& x, Vec3& total) {
        const Ball ball(wall_.shell_, centre, wall_.ball_radius_mm_, 4.0 * wall_.spacing_mm_, wall_.young_kpa_,
                        wall_.thickness_mm_);
        const ShellLoad load = [&](std::span<const Vec3> at_x, std::span<Vec3> force,
                                   std::vector<Eigen::Triplet<double>>& stiffness) {
            return ball(at_x, force, stiffness, total) + surround(at_x, force, stiffness);
        };
        for (int round = 0;; ++round) {
            if (!shell_equilibrium(wall_.shell_, wall_.fixed_, load, x, rest_)) return false;
            if (!law_.slip) break;
            const double moved = let_slip(x);
            if (round >= most_rounds || moved < still_mm) break;
        }
        return ball.inside(x);  // a wall that jumped over the ball is at rest as well
    }

    void keep(const std::vector<Vec3>& x) {
        if (law_.membrane && law_.remember)
            for (std::size_t k = 0; k < wall_.shell_.triangles.size(); ++k) {
                const Eigen::Matrix2d e = shell_strain(wall_.shell_.triangles[k], x);
                MembranePoint point = point_of(k, Vec3(1.0 + 2.0 * e(0, 0), 1.0 + 2.0 * e(1, 1), 2.0 * e(0, 1)));
                law_.membrane(material_of(k), point);
                law_.remember(point);
            }
        if (law_.slip && law_.remember_slip)
            for (std::size_t i = 0; i < x.size(); ++i)
                if (wall_.fixed_[i]) law_.remember_slip(i, traction(i));
    }

    double surround(std::span<const Vec3> x, std::span<Vec3> force,
                    std::vector<Eigen::Triplet<double>>& stiffness) const {
        if (law_.support_kpa_per_mm <= 0.0) return 0.0;
        double potential = 0.0;
        for (std::size_t i = 0; i < x.size(); ++i) {
            const double k = law_.support_kpa_per_mm * wall_.area_mm2_[i];
            const Vec3 off = x[i] - wall_.rest_[i];
            potential += 0.5 * k * off.squaredNorm();
            force[i] -= k * off;
            for (int axis = 0; axis < 3; ++axis)
                stiffness.emplace_back(static_cast<int>(3 * i) + axis, static_cast<int>(3 * i) + axis, k);
        }
        return potential;
    }

    static MembranePoint point_of(std::size_t k, const Vec3& c) {
        MembranePoint point;
        point.index = k;
        point.c = c;
        return point;
    }
    MembraneMaterial material_of(std::size_t k) const {
        const ShellTriangle& t = wall_.shell_.triangles[k];
        return {t.mu_kpa, t.thinning, t.round};
    }

    Vec3 traction(std::size_t i) const { return pull_[i] / (wall_.thickness_mm_ * std::sqrt(wall_.area_mm2_[i])); }

    /// What holds the wall goes towards where its law says, as far as is stable; how far it still has to go.
    double let_slip(std::vector<Vec3>& x) {
        pull_.assign(x.size(), Vec3::Zero());
        if (rest_.law)
            add_shell_forces(wall_.shell_, x, pull_, rest_.law);
        else
            add_shell_forces(wall_.shell_, x, pull_, law_.fibres);
        double far = 0.0;
        for (std::size_t i = 0; i < x.size(); ++i) {
            if (!wall_.fixed_[i]) continue;
            constexpr double part = 0.01;
            const Vec3 pulled = traction(i), wanted = law_.slip(i, pulled);
            const double size = part * pulled.norm();
            const double gain = size > 0.0 ? (law_.slip(i, (1.0 + part) * pulled) - wanted).norm() / size : 0.0;
            const double stiff = wall_.holding_[i] / (wall_.thickness_mm_ * std::sqrt(wall_.area_mm2_[i]));
            const Vec3 go = (wanted - slipped_[i]) / (1.0 + gain * stiff);
            slipped_[i] += go;
            x[i] = wall_.rest_[i] + slipped_[i];
            far = std::max(far, go.norm());
        }
        return far;
    }

    const PushedWall& wall_;
    const PushedLaw& law_;
    ShellFactors factors_;
    ShellRest rest_;
    std::vector<Vec3> slipped_, pull_;
};

PushResult PushedWall::push(const Push& push, const PushedLaw& law, const std::function<bool()>& go_on) const {
    PushResult out;
    const std::size_t samples = push.ball_mm.size();
    constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
    out.marker_mm.assign(samples, Vec3::Constant(unknown));
    out.force_mn.assign(samples, unknown);
    if (samples == 0) return out;
    const Vec3& first = push.ball_mm.front();
    const Vec3& farthest = *std::max_element(
        push.ball_mm.begin(), push.ball_mm.end(),
        [&](const Vec3& a, const Vec3& b) { return (a - first).squaredNorm() < (b - first).squaredNorm(); });
    const Vec3 along = farthest == first ? Vec3(Vec3::Zero()) : Vec3((farthest - first).normalized());
    const Marker marker(shell_, rest_, push.marker_mm);
    std::vector<Vec3> x = rest_;
    Sample sample(*this, law);
    const bool remembers = law.remember || law.remember_slip;
    std::size_t last = 0;  // sample that was searched for
    for (std::size_t k = 0; k < samples; ++k) {
        // An elastic wall without friction does not remember the way: unloading is loading once more.
        const auto met = std::find_if(push.ball_mm.begin(), push.ball_mm.begin() + static_cast<std::ptrdiff_t>(k),
                                      [&](const Vec3& p) { return (p - push.ball_mm[k]).squaredNorm() < 1e-12; });
        const auto known = static_cast<std::size_t>(met - push.ball_mm.begin());
        if (law.begin) law.begin(k);
        if (known < k && !remembers) {
            out.marker_mm[k] = out.marker_mm[known];
            out.force_mn[k] = out.force_mn[known];
            if (push.keep_wall) out.wall_mm.push_back(out.wall_mm[known]);
            continue;
        }
        const std::vector<Vec3> before = x;
        if (k < push.guess.size()) {  // the way that the guess takes, from where the wall is
            const std::vector<Vec3>& from = k > 0 ? push.guess[last] : rest_;
            for (std::size_t i = 0; i < x.size(); ++i) sample.go(i, push.guess[k][i] - from[i], x);
        }
        if (k < push.factors.size()) {
            if (!push.factors[k]) push.factors[k] = std::make_shared<ShellFactors>();
            sample.use(push.factors[k].get());
        }
        Vec3 total = Vec3::Zero();
        if ((go_on && !go_on()) || !sample.solve(push.ball_mm[last], push.ball_mm[k], before, x, total)) {
            out.at_rest = false;
            return out;
        }
        last = k;
        if (push.keep_wall) out.wall_mm.push_back(x);
        out.marker_mm[k] = marker.place(x);
        out.force_mn[k] = total.dot(along);
    }
    return out;
}

}  // namespace cathlab
