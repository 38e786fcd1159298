// The wall as a thin elastic shell on the triangles of its particles: what it stores when it is stretched, sheared and
// bent.  The particles lie on the shell's middle surface.
//
// Membrane: neo-Hookean, thickness free (plane stress), constant strain in a triangle.  With F the gradient of the
// triangle's deformation (3 x 2), C = F^T F, d = det C, mu = E / (2 (1 + nu)) and a = nu / (1 - nu), of the volume at
// rest
//     energy = mu/2 [ tr C - 2 + (d^-a - 1) / a ],      stress  S = mu (1 - d^-a C^-1)   (second Piola-Kirchhoff);
// d^-a is the square of the thickness' stretch: Ogden's compressible neo-Hookean solid, whose stress across the wall is
// 0. Small strains: Hooke's law in plane stress.  nu -> 1/2: the wall keeps its volume.  Fibres (fibres.h) add theirs.
//
// Bending: Koiter's, isotropic.  b = n . (second derivatives of position), n the triangle's normal; with kappa = b - b
// at rest
//     energy = 1/2 D area [ (1 - nu) kappa : kappa + nu (tr kappa)^2 ],      D = E t^3 / (12 (1 - nu^2)).
// Second derivatives are those of edge_slopes.h.
// Sections that are stretched (ShellOptions): kappa = y b - b at rest, y^2 = d^-a, and the membrane's own stiffness at
// C in place of that at rest, what a neo-Hookean solid does of first order across the wall [kiendl2015]. Forces are
// exact gradients of an energy that rigid motions leave alone: they add up to no force and no moment.
#pragma once

#include <Eigen/Sparse>
#include <array>
#include <functional>
#include <span>
#include <vector>

#include "core/types.h"
#include "softbody/fibres.h"

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
    double mu_kpa = 0.0, thickness_mm = 0.0;
    double thinning = 0.0;  ///< a = nu / (1 - nu)
    Eigen::Vector2d round =
        Eigen::Vector2d::Zero();  ///< cos, sin of twice the angle from the frame's first axis to the
                                  ///< vessel's circumference; 0, 0: fibres lie in every direction
    double bending_mn_mm = 0.0;   ///< D
    double poisson = 0.0;
    Vec3 rest_curvature = Vec3::Zero();  ///< b at rest: 11, 22, 12, 1/mm, in that frame
    std::vector<Index> patch;            ///< particles that bending sees, the corners first; then heights (give_shear)
    std::size_t bent = 0;                ///< how many of the patch are particles
    bool stretched_section = false;      ///< ShellOptions
    Triangle height{-1, -1, -1};         ///< of the corners; -1 = none
    Mat3 held_second = Mat3::Zero();     ///< what edges that are held flat add to these derivatives: columns 11, 22, 12
    std::vector<Vec3> second;  ///< one a member of the patch: its weight in d2/d11, d2/d22, d2/d12 of position
};

struct ShellModel {
    std::size_t particles = 0, heights = 0;
    std::vector<ShellTriangle> triangles;

    std::size_t unknowns() const { return particles + heights; }
};

struct ShellOptions {
    std::span<const Vec3> along = {};         ///< the vessel's direction, one a particle (any length; 0 = none), or
                                              ///< empty for none: fibres go round it
    std::span<const std::uint8_t> held = {};  ///< one a particle or empty: an open edge between two that are marked
                                              ///< keeps its slope, as if it were clamped
    bool stretched_sections = false;          ///< they bend as thin, as wide and as stiff as they are by then
};

/// rest: (n) mm.  triangles: outward, no edge shared by more than two (CATHLAB_CHECK).  material: one a triangle, or
/// one for all.  Throws UserError for numbers out of range and for a triangle without area.
ShellModel build_shell(std::span<const Vec3> rest, std::span<const Triangle> triangles,
                       std::span<const ShellMaterial> material, const ShellOptions& options = {});

/// Lets the wall shear across its thickness at the particles that are marked, where a load is concentrated on about its
/// thickness.  Each of them has a height w, what of its place along the normal is shear: kappa = b - b at rest - the
/// second derivatives of w, and energy += 1/2 (5/6) mu t area |grad w|^2 (Mindlin's plate [mindlin1951], split into the
/// part that bends and the part that shears).  Heights stand after the particles in x and in forces, each as the first
/// component of one entry; at rest they are 0.
void give_shear(ShellModel& model, std::span<const std::uint8_t> where);

/// A law in place of the membrane's own: second Piola-Kirchhoff stress of triangle k, kPa, at C (both 11, 22, 12, in
/// the triangle's frame).  It says all of it, fibres too.
using ShellLaw = std::function<Vec3(std::size_t k, const Vec3& c)>;

/// Stored energy at positions x (n), uJ.
double shell_energy(const ShellModel& model, std::span<const Vec3> x, const Fibres& fibres = {});

/// Adds the forces of the shell on its particles, mN (minus the energy's gradient).
void add_shell_forces(const ShellModel& model, std::span<const Vec3> x, std::span<Vec3> force,
                      const Fibres& fibres = {});
/// The same with a law for the membrane; bending stays as it is.
void add_shell_forces(const ShellModel& model, std::span<const Vec3> x, std::span<Vec3> force, const ShellLaw& law);

/// The energy's second derivatives at x (3n x 3n, lower triangle), mN/mm, without the parts that may make it
/// indefinite: compressed membranes' geometric stiffness, and the change of the normals in bending.
Eigen::SparseMatrix<double> shell_stiffness(const ShellModel& model, std::span<const Vec3> x,
                                            const Fibres& fibres = {});

/// Takes a block (3 x 3) of the stiffness: of the force on particle i, times -1, by the place of particle j.
using ShellBlocks = std::function<void(Index i, Index j, const Mat3& block)>;
/// The same numbers, block by block, each triangle's in turn (a pair of particles comes several times; i < j is left
/// out).
void shell_stiffness_blocks(const ShellModel& model, std::span<const Vec3> x, const Fibres& fibres,
                            const ShellBlocks& add);
/// With a law for the membrane: its derivatives are taken by differences, made symmetric, and never below a trace of
/// the shell's own stiffness.
void shell_stiffness_blocks(const ShellModel& model, std::span<const Vec3> x, const ShellLaw& law,
                            const ShellBlocks& add);

/// Green's strain of a triangle at x, in its rest frame.
Eigen::Matrix2d shell_strain(const ShellTriangle& triangle, std::span<const Vec3> x);

}  // namespace cathlab
