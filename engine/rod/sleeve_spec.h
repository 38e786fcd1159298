// A passive catheter over the guidewire: a tube of sections that slides on the wire.
#pragma once

#include <string>
#include <vector>

#include "rod/wire_spec.h"

namespace cathlab {

/// A passive catheter as an asset file gives it (assets/devices/*.toml, kind = "passive_catheter").  A section's
/// stiffnesses are those of the tube, its diameter is the outer one, its density the mean over the full outer circle,
/// its rest curvature the tip's own shape.
struct SleeveSpec {
    std::string name;
    double length_mm = 0.0;             ///< total
    double link_length_mm = 0.0;        ///< longest rigid link, 0.2 .. 50
    double inner_diameter_mm = 0.0;     ///< 0.05 to less than the smallest outer diameter
    std::vector<WireSection> sections;  ///< tip first
    double friction = 0.1;              ///< Coulomb coefficient against the wall, 0 .. 2
    double wire_friction = 0.1;         ///< the same between it and the guidewire inside, 0 .. 2
    double max_push_n = 10.0;           ///< the axial force at which its drive slips, N
    double max_speed = 100.0;           ///< of the drive, mm/s
    std::string source;                 ///< key in docs/references.md
};

/// The tube alone as a wire, which is how it is cut into links and checked.
WireSpec as_wire(const SleeveSpec& sleeve);

/// Throws UserError that names the key, the value and what is allowed.
void validate(const SleeveSpec& sleeve);

/// The same, and that this wire goes through it.
void validate(const SleeveSpec& sleeve, const WireSpec& wire);

}  // namespace cathlab
