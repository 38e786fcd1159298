#include "softbody/pressed_ball.h"

#include <algorithm>
#include <array>

namespace cathlab {

namespace {

constexpr int parts = 5;  // a triangle's edge is cut into so many for the contact's points

std::size_t at(Index i) {
    return static_cast<std::size_t>(i);
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

}  // namespace

PressedBall::PressedBall(const ShellModel& shell, const Vec3& centre, double radius_mm, double near_mm,
                         double young_kpa, double thickness_mm)
    : shell_(shell),
      centre_(centre),
      radius_(radius_mm),
      near_(near_mm),
      young_kpa_(young_kpa),
      thickness_mm_(thickness_mm),
      points_(contact_points()) {}

double PressedBall::operator()(std::span<const Vec3> x, std::span<Vec3> force,
                               std::vector<Eigen::Triplet<double>>& stiffness, Vec3& total) const {
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
                            block[static_cast<std::size_t>(std::max(i, j) * (std::max(i, j) + 1) / 2 + std::min(i, j))](
                                r, c));
    }
    return potential;
}

bool PressedBall::inside(std::span<const Vec3> x) const {
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

/// The bed pressed by a depth > 0: what is left of its thickness is l of it,
///     p = E/3 (l^-2 - l),   l = 1 - depth / t,
/// a neo-Hookean bar's; on in a straight line where less than least_left is left.
PressedBall::Pressed PressedBall::pressed(double depth) const {
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

}  // namespace cathlab
