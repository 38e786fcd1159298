// What a guidewire is made of: sections along its length, each with its own stiffness, counted from the tip.
#pragma once

#include <string>
#include <vector>

namespace cathlab {

/// A stretch of wire with constant properties.  Stiffnesses are those of the whole cross-section, in the catalogue's
/// units.
struct WireSection {
    double length_mm = 0.0;                ///< > 0; the last section runs to the end of the wire whatever it says
    double diameter_mm = 0.0;              ///< outer, 0.05 .. 10
    double bending_stiffness_n_mm2 = 0.0;  ///< EI, 1e-3 .. 1e6
    double torsion_stiffness_n_mm2 = 0.0;  ///< GJ, 1e-3 .. 1e6; solid round bar: EI / (1 + nu)
    double axial_stiffness_n = 0.0;        ///< EA, 1 .. 1e7; solid round bar: 16 EI / diameter^2
    double density_kg_m3 = 0.0;            ///< mean over the full circle, 100 .. 25000
    double rest_curvature_per_mm = 0.0;    ///< of the unloaded wire, in one plane for all sections; |.| <= 1
    double link_length_mm = 0.0;           ///< 0 = the wire's
    std::string material;                  ///< name in assets/materials: what the X-ray image sees
};

/// A guidewire as an asset file gives it (assets/devices/*.toml, kind = "wire").
struct WireSpec {
    std::string name;
    double length_mm = 0.0;             ///< total
    double link_length_mm = 0.0;        ///< longest rigid link, 0.2 .. 50; a section is cut into equal links no longer
    std::vector<WireSection> sections;  ///< tip first
    double friction = 0.1;              ///< Coulomb coefficient against the wall, 0 .. 2
    double max_push_n = 5.0;            ///< the axial force at which the drive slips, N
    double max_speed = 100.0;           ///< of the drive, mm/s
    double damping_per_s = 20.0;        ///< rate at which a link's motion against resting blood dies out (see below)
    double spin_damping_per_s = 20.0;   ///< the same for its angular velocity
    std::string source;                 ///< key in docs/references.md
};
// The rate of damping: a cylinder across slow flow feels about 4 pi eta a length and speed over ln(...) ~ 2, with
// blood's eta = 3.5 mPa s [batchelor1970]: 30 /s for a steel wire of 0.36 mm and 5 /s for one of 0.89
// mm.

/// Throws UserError that names the key (sections[2].length_mm, counted from the tip from 0), the value and what is
/// allowed.
void validate(const WireSpec& spec);

}  // namespace cathlab
