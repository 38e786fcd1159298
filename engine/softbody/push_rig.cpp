#include "softbody/push_rig.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <string>

#include "core/check.h"
#include "core/errors.h"
#include "softbody/pressed_ball.h"
#include "softbody/shell_statics.h"
#include "softbody/tube.h"
#include "softbody/wall_sample.h"

namespace cathlab {

namespace {

constexpr double mesh_per_spacing = 0.4;  // edges of the fine surface, of the particles' spacing
constexpr double growth = 0.3;            // of the spacing, a mm away from where the wall is looked at
constexpr double force_tolerance_mn = 1e-2;
constexpr double sheared_thicknesses = 3.0;  // beyond the ball
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
    // Particles are sparse, and none lies on the rim of an open end: those of the last row stand for the ring that is
    // held, and stand on it.  A wall that is held half a spacing too early is too short.
    const auto held_by = [&](const HeldDisc& disc, const Vec3& p, double reach) {
        const Vec3 off = p - disc.center;
        return std::fabs(off.dot(disc.normal)) <= disc.half_thickness_mm + reach &&
               off.norm() <= disc.radius_mm + reach;
    };
    fixed_.assign(rest_.size(), 0);
    std::vector<std::uint8_t> moved(rest_.size(), 0);
    for (const HeldDisc& disc : rig.held) {
        std::vector<Vec3> ring, taken;
        for (const Vec3& v : middle.vertices)
            if (held_by(disc, v, 0.0)) ring.push_back(v);
        std::vector<std::size_t> beside;
        for (std::size_t i = 0; i < rest_.size(); ++i) {
            if (fixed_[i] != 0 || !held_by(disc, rest_[i], 0.6 * spacing_at(rest_[i]))) continue;
            fixed_[i] = 1;
            if (held_by(disc, rest_[i], 0.0))
                taken.push_back(rest_[i]);
            else
                beside.push_back(i);
        }
        for (const std::size_t i : beside) {
            const Vec3 p = rest_[i];
            const auto nearest = [&](const std::vector<Vec3>& places, const Vec3& from) {
                return *std::min_element(places.begin(), places.end(), [&](const Vec3& a, const Vec3& b) {
                    return (a - from).squaredNorm() < (b - from).squaredNorm();
                });
            };
            if (ring.empty()) break;
            const Vec3 place = nearest(ring, p);
            // Of two, one behind the other, the second stays.
            if (!taken.empty() && (nearest(taken, place) - place).norm() < 0.5 * spacing_at(p)) continue;
            rest_[i] = place;
            moved[i] = 1;
            taken.push_back(place);
        }
    }
    // Three neighbours on one ring may lie in a line, and have nothing to say.
    std::vector<Triangle> triangles = sample.triangles;
    std::erase_if(triangles, [&](const Triangle& t) {
        const auto all = [&](const std::vector<std::uint8_t>& marks) {
            return std::all_of(t.begin(), t.end(), [&](Index corner) { return marks[at(corner)] != 0; });
        };
        return all(fixed_) && std::any_of(t.begin(), t.end(), [&](Index corner) { return moved[at(corner)] != 0; });
    });
    if (std::count(fixed_.begin(), fixed_.end(), 1) < 3)
        throw UserError("the wall is held nowhere: no three particles lie within the discs of [[setup.fixed]]");
    const ShellMaterial material{rig.young_kpa, rig.poisson, rig.thickness_mm};
    shell_ = build_shell(rest_, triangles, {&material, 1}, {.held = fixed_, .stretched_sections = true});
    const Eigen::SparseMatrix<double> k = shell_stiffness(shell_, rest_);
    holding_.assign(rest_.size(), 0.0);
    for (std::size_t i = 0; i < rest_.size(); ++i)
        for (int axis = 0; fixed_[i] && axis < 3; ++axis)
            holding_[i] = std::max(
                holding_[i], k.coeff(static_cast<Eigen::Index>(3 * i) + axis, static_cast<Eigen::Index>(3 * i) + axis));
    // Where the ball may be it is sheared, too, which particles much further apart than it is thick do not see.
    std::vector<std::uint8_t> sheared(rest_.size(), 0);
    for (std::size_t i = 0; i < rest_.size(); ++i) {
        const auto near = [&](const Vec3& place) {
            return (place - rest_[i]).norm() < ball_radius_mm_ + sheared_thicknesses * rig.thickness_mm;
        };
        sheared[i] = fixed_[i] == 0 && spacing_at(rest_[i]) < 2.0 * rig.thickness_mm &&
                     std::any_of(rig.looked_at.begin(), rig.looked_at.end(), near);
    }
    give_shear(shell_, sheared);
    rest_.resize(shell_.unknowns(), Vec3::Zero());
    area_mm2_.resize(shell_.unknowns(), 0.0);
    holding_.resize(shell_.unknowns(), 0.0);
    fixed_.resize(shell_.unknowns(), 0);
}

PushResult PushedWall::push(const Push& push, const std::function<bool()>& go_on) const {
    return this->push(push, PushedLaw{}, go_on);
}

/// One place of the ball: the wall at rest there, with what effects make of it.
class PushedWall::Sample {
public:
    Sample(const PushedWall& wall, const PushedLaw& law) : wall_(wall), law_(law) {
        bonds_.resize(law.slip ? wall.rest_.size() : 0);
        held_ = wall.fixed_;
        if (law.slip) std::fill(held_.begin(), held_.end(), std::uint8_t{0});  // their bonds hold them
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

    /// Whether particle i goes nowhere.
    bool stands(std::size_t i) const { return held_[i] != 0; }

    /// As settle(); where that finds no rest, the ball takes the way from `before` in small parts.
    bool solve(const Vec3& before, const Vec3& centre, const std::vector<Vec3>& from, std::vector<Vec3>& x,
               Vec3& total) {
        bool found = settle(centre, x, total);
        for (int tries = 0, count = 4; !found && tries < 2; ++tries, count *= 4) {
            x = from;
            rest_.factors->usable = false;
            found = true;
            for (int k = 1; k <= count && found; ++k)
                found = settle(before + (centre - before) * (static_cast<double>(k) / count), x, total);
        }
        if (found) keep(x);
        return found;
    }

private:
    static constexpr int most_rounds = 20;
    static constexpr int most_iterations = 200, most_with_a_law = 60;
    static constexpr double still_mm = 1e-3;

    /// What holds a particle, as its law is about where the wall pulls now: traction = pull + spring (slipped - slip).
    struct Bond {
        Vec3 pull = Vec3::Zero(), slip = Vec3::Zero();
        Mat3 spring = Mat3::Identity();  ///< kPa/mm
    };

    /// Moves x to rest; total: the ball's force.
    bool settle(const Vec3& centre, std::vector<Vec3>& x, Vec3& total) {
        const PressedBall ball(wall_.shell_, centre, wall_.ball_radius_mm_, 4.0 * wall_.spacing_mm_, wall_.young_kpa_,
                               wall_.thickness_mm_);
        const ShellLoad load = [&](std::span<const Vec3> at_x, std::span<Vec3> force,
                                   std::vector<Eigen::Triplet<double>>& stiffness) {
            return ball(at_x, force, stiffness, total) + surround(at_x, force, stiffness) +
                   hold(at_x, force, stiffness);
        };
        for (int round = 0; law_.slip; ++round) {
            const double off = tie(x, load);
            if (round > 0 && off < still_mm) break;
            if (round == most_rounds || !shell_equilibrium(wall_.shell_, held_, load, x, rest_)) return false;
        }
        if (!law_.slip && !shell_equilibrium(wall_.shell_, held_, load, x, rest_)) return false;
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
                if (wall_.fixed_[i]) law_.remember_slip(i, bonds_[i].pull);
    }

    double surround(std::span<const Vec3> x, std::span<Vec3> force,
                    std::vector<Eigen::Triplet<double>>& stiffness) const {
        if (law_.support_kpa_per_mm <= 0.0) return 0.0;
        double potential = 0.0;
        for (std::size_t i = 0; i < wall_.particles(); ++i) {
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

    double section_mm2(std::size_t i) const { return wall_.thickness_mm_ * std::sqrt(wall_.area_mm2_[i]); }

    /// The bonds on the particles that they hold.
    double hold(std::span<const Vec3> x, std::span<Vec3> force, std::vector<Eigen::Triplet<double>>& stiffness) const {
        double potential = 0.0;
        for (std::size_t i = 0; i < bonds_.size(); ++i) {
            if (!wall_.fixed_[i]) continue;
            const Bond& bond = bonds_[i];
            const Vec3 slipped = x[i] - wall_.rest_[i], off = slipped - bond.slip;
            const double section = section_mm2(i);
            potential += section * (bond.pull.dot(slipped) + 0.5 * off.dot(bond.spring * off));
            force[i] -= section * (bond.pull + bond.spring * off);
            for (int r = 0; r < 3; ++r)
                for (int c = 0; c < 3; ++c)
                    stiffness.emplace_back(static_cast<int>(3 * i) + r, static_cast<int>(3 * i) + c,
                                           section * bond.spring(r, c));
        }
        return potential;
    }

    /// The law of the bonds about what pulls at them at x; how far, at most, one stands beside it.
    double tie(const std::vector<Vec3>& x, const ShellLoad& load) {
        // A bond that does not give way is this much stiffer than what it holds.
        constexpr double stiffer = 100.0, part = 1e-3, least_kpa = 1e-3;
        std::vector<Vec3> pull(x.size(), Vec3::Zero());
        std::vector<Eigen::Triplet<double>> unused;
        load(x, pull, unused);
        if (rest_.law)
            add_shell_forces(wall_.shell_, x, pull, rest_.law);
        else
            add_shell_forces(wall_.shell_, x, pull, law_.fibres);
        double far = 0.0;
        for (std::size_t i = 0; i < x.size(); ++i) {
            if (!wall_.fixed_[i]) continue;
            Bond& bond = bonds_[i];
            const double section = section_mm2(i);
            const Vec3 slipped = x[i] - wall_.rest_[i];
            // What is left of the forces, beside what the bond holds already.
            bond.pull = pull[i] / section + bond.pull + bond.spring * (slipped - bond.slip);
            bond.slip = law_.slip(i, bond.pull);
            far = std::max(far, (slipped - bond.slip).norm());
            const double change = part * bond.pull.norm() + least_kpa;
            Mat3 give;  // mm/kPa
            for (int axis = 0; axis < 3; ++axis) {
                Vec3 more = bond.pull;
                more[axis] += change;
                give.col(axis) = (law_.slip(i, more) - bond.slip) / change;
            }
            const double least = section / (stiffer * wall_.holding_[i]);
            const Eigen::SelfAdjointEigenSolver<Mat3> axes(0.5 * (give + give.transpose()));
            const Mat3 spring = axes.eigenvectors() * axes.eigenvalues().cwiseMax(least).cwiseInverse().asDiagonal() *
                                axes.eigenvectors().transpose();
            if ((spring - bond.spring).norm() > 0.5 * bond.spring.norm()) rest_.factors->usable = false;
            bond.spring = spring;
        }
        return far;
    }

    const PushedWall& wall_;
    const PushedLaw& law_;
    ShellFactors factors_;
    ShellRest rest_;
    std::vector<std::uint8_t> held_;
    std::vector<Bond> bonds_;  // (n) where something slips
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
            for (std::size_t i = 0; i < x.size(); ++i)
                if (!sample.stands(i)) x[i] += push.guess[k][i] - from[i];
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
