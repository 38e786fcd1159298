// The wall as a thin elastic shell on the triangles of its particles: what it stores when it is stretched, sheared and
// bent.  The particles lie on the shell's middle surface.
//
// Membrane: neo-Hookean, thickness free (plane stress), constant strain in a triangle.  With F the gradient of the
// triangle's deformation (3 x 2), C = F^T F, J = sqrt(det C) and mu, lambda of E and nu, the thickness' stretch s obeys
//     mu (s^2 - 1) + lambda ln(J s) = 0,          and the stress is  S = mu (1 - s^2 C^-1)   (second Piola-Kirchhoff).
// Small strains: Hooke's law in plane stress.  nu -> 1/2: s = 1 / J, incompressible.
//
// Bending: Koiter's, isotropic.  b = n . (second derivatives of position), by a quadratic through the triangle and its
// neighbours (rotation-free triangles, [flores2005]), n the triangle's normal; with kappa = b - b at rest
//     energy = 1/2 D area [ (1 - nu) kappa : kappa + nu (tr kappa)^2 ],      D = E t^3 / (12 (1 - nu^2)).
// Forces are exact gradients of an energy that rigid motions leave alone: they add up to no force and no moment.
#pragma once

#include <Eigen/Sparse>
#include <array>
#include <span>
#include <vector>

#include "core/types.h"

namespace cathlab {

struct ShellMaterial {
    double young_kpa = 500.0;   ///< E, > 0
    double poisson = 0.49;      ///< nu, 0 to 0.4999
    double thickness_mm = 1.0;  ///< t, > 0
};

struct ShellTriangle {
    Triangle corner;  ///< particles, outward
    Eigen::Matrix2d
        rest_inverse;       ///< F = [x1 - x0, x2 - x0] rest_inverse, in an orthonormal frame of the triangle at rest
    double area_mm2 = 0.0;  ///< at rest
    double mu_kpa = 0.0, lambda_kpa = 0.0, thickness_mm = 0.0;
    double bending_mn_mm = 0.0;  ///< D
    double poisson = 0.0;
    Vec3 rest_curvature = Vec3::Zero();  ///< b at rest: 11, 22, 12, 1/mm, in that frame
    std::vector<Index> patch;            ///< particles that bending sees, the corners first
    std::vector<Vec3> second;  ///< one a particle of the patch: its weight in d2/d11, d2/d22, d2/d12 of position
};

struct ShellModel {
    std::size_t particles = 0;
    std::vector<ShellTriangle> triangles;
};

/// rest: (n) mm.  triangles: outward, no edge shared by more than two (CATHLAB_CHECK).  material: one a triangle, or
/// one for all.  Throws UserError for numbers out of range and for a triangle without area.
ShellModel build_shell(std::span<const Vec3> rest, std::span<const Triangle> triangles,
                       std::span<const ShellMaterial> material);

/// Stored energy at positions x (n), uJ.
double shell_energy(const ShellModel& model, std::span<const Vec3> x);

/// Adds the forces of the shell on its particles, mN (minus the energy's gradient).
void add_shell_forces(const ShellModel& model, std::span<const Vec3> x, std::span<Vec3> force);

/// The energy's second derivatives at x (3n x 3n, lower triangle), mN/mm, without the parts that may make it
/// indefinite: compressed membranes' geometric stiffness, and the change of the normals in bending.
Eigen::SparseMatrix<double> shell_stiffness(const ShellModel& model, std::span<const Vec3> x);

/// Green's strain of a triangle at x, in its rest frame.
Eigen::Matrix2d shell_strain(const ShellTriangle& triangle, std::span<const Vec3> x);

}  // namespace cathlab
