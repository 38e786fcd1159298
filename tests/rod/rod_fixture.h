// A straight uniform wire in a sheath at the origin that looks along z, and how to bring it to rest.
#pragma once

#include <span>
#include <vector>

#include "rod/rod.h"

namespace cathlab::test {

inline WireSpec uniform_wire(double bending_n_mm2, double diameter_mm, double link_mm, double length_mm = 600.0) {
    WireSection section;
    section.length_mm = length_mm;
    section.diameter_mm = diameter_mm;
    section.bending_stiffness_n_mm2 = bending_n_mm2;
    section.torsion_stiffness_n_mm2 = bending_n_mm2 / 1.3;
    section.axial_stiffness_n = 16.0 * bending_n_mm2 / (diameter_mm * diameter_mm);
    section.density_kg_m3 = 7900.0;
    section.material = "steel";
    WireSpec spec;
    spec.name = "uniform";
    spec.length_mm = length_mm;
    spec.link_length_mm = link_mm;
    spec.sections = {section};
    return spec;
}

inline WireSpec bmw(double link_mm = 3.0) {
    return uniform_wire(75.0, 0.356, link_mm);
}
inline WireSpec amplatz(double link_mm = 3.0) {
    return uniform_wire(1850.0, 0.889, link_mm, 1200.0);
}

inline void substep(Rod& rod, double h, std::span<const Vec3> force = {}, std::span<ChainRow> rows = {},
                    double advance = 0.0, double rotate = 0.0) {
    rod.command(advance, rotate);
    rod.predict(h, force);
    rod.solve(h, rows);
    rod.solve(h, rows);
    rod.finish(h);
}

/// Steps under a constant force on one link until nothing moves.  Long steps: implicit Euler then goes straight to
/// rest.
inline void settle(Rod& rod, std::size_t link, const Vec3& force, double h = 0.5, int steps = 400) {
    std::vector<Vec3> forces(link + 1, Vec3::Zero());
    forces[link] = force;
    for (int i = 0; i < steps; ++i) substep(rod, h, forces);
}

}  // namespace cathlab::test
