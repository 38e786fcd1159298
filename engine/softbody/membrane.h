// One point of the elastic wall's membrane, as its law is asked: the law of shell.h, and what effects of the material
// change of it.  Solver, statics and the closed form of a uniform specimen ask the same functions.
//
// Tensors are given by their components 11, 22, 12 in a frame at rest.
#pragma once

#include <cstddef>

#include "core/types.h"
#include "softbody/fibres.h"

namespace cathlab {

/// What the law of a point needs to know of it.
struct MembraneMaterial {
    double mu_kpa = 0.0;        ///< E / (2 (1 + nu))
    double thinning = 0.0;      ///< a = nu / (1 - nu)
    Vec2 round = Vec2::Zero();  ///< as ShellTriangle::round; 0, 0 = fibres lie in every direction
    /// Part of the stress that obeys Hooke's law in the stretches instead, U = C^1/2, in plane stress:
    ///     U S = E / (1 - nu^2) [(1 - nu) (U - 1) + nu tr(U - 1) 1].
    /// The walls of shell.h have none of it; some specimens are described so.
    double hooke = 0.0;
};

struct MembranePoint {
    std::size_t index = 0;       ///< which: effects keep their memory by it
    Vec3 c = Vec3(1, 1, 0);      ///< C; effects take from it what bears no stress
    Vec3 stress = Vec3::Zero();  ///< S, second Piola-Kirchhoff, kPa
    double mu_kpa = 0.0;         ///< of the elastic law
    double energy_kpa = 0.0;     ///< W, stored by the elastic law
    double at_once = 1.0;        ///< how many times as stiff as the elastic law the wall is when strained at once
};

/// S = mu (1 - d^-a C^-1) and W = mu/2 [tr C - 2 + (d^-a - 1) / a], d = det C, and the fibres' share (fibres.h), at
/// point.c.  With hooke > 0 both laws are mixed, stress and energy.
void ask_elastic_law(const MembraneMaterial& material, const Fibres& fibres, MembranePoint& point);

}  // namespace cathlab
