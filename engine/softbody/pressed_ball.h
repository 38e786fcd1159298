// A rigid ball that presses on a shell from inside, without friction, through a bed of neo-Hookean bars as long as the
// wall is thick.
#pragma once

#include <Eigen/Sparse>
#include <span>
#include <vector>

#include "softbody/shell.h"

namespace cathlab {

class PressedBall {
public:
    /// radius: to the shell's middle surface.  near: no triangle is larger.
    PressedBall(const ShellModel& shell, const Vec3& centre, double radius_mm, double near_mm, double young_kpa,
                double thickness_mm);

    /// As ShellLoad; total: the ball's force on the wall, mN.
    double operator()(std::span<const Vec3> x, std::span<Vec3> force, std::vector<Eigen::Triplet<double>>& stiffness,
                      Vec3& total) const;

    /// Whether the ball's centre is on the inner side of the wall that is nearest to it.
    bool inside(std::span<const Vec3> x) const;

private:
    struct Pressed {
        double pressure_kpa = 0.0, slope_kpa_per_mm = 0.0, energy_kpa_mm = 0.0;
    };
    Pressed pressed(double depth) const;

    const ShellModel& shell_;
    Vec3 centre_;
    double radius_, near_, young_kpa_, thickness_mm_;
    std::vector<Vec3> points_;  ///< weights of the contact's points of a triangle on its corners
};

}  // namespace cathlab
