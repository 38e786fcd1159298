// What a steerable catheter is: lengths, ranges, rates and limits.  Const after load.
#pragma once

#include <string>
#include <vector>

#include "core/errors.h"

namespace cathlab {

/// A length of catheter that bends as an arc of constant curvature.
struct CatheterSegment {
    std::string name;
    double length_mm = 0.0;       ///< along the centre-line, > 0
    double max_bend_deg = 0.0;    ///< largest angle between its two ends, 0 to 180
    double max_rate_deg_s = 0.0;  ///< fastest change of the bend vector (bend, direction), > 0
    std::string driven_by = {};   ///< "proximal", "distal" or "none": the operator's bend that it follows; "" = by its
                                  ///< place: the first follows proximal, the last one of several distal, no other any
};

/// A kinematic catheter: a shaft that follows the vessel, then segments joined by rigid links, then a straight tip.
/// The defaults are the 6 Fr robotic catheter [li2025]: 25 mm to 60 deg, 30 mm to 140 deg.
struct CatheterSpec {
    std::string name = "magellan-6f";
    double length_mm = 950.0;        ///< usable length beyond the sheath's mouth
    double outer_diameter_mm = 2.0;  ///< 6 Fr
    double inner_diameter_mm = 1.0;  ///< lumen for a guidewire; 0 = none
    std::vector<CatheterSegment> segments = {{"proximal", 25.0, 60.0, 60.0},
                                             {"distal", 30.0, 140.0, 140.0}};  ///< base first
    double link_length_mm = 5.0;    ///< straight and rigid, between neighbouring segments
    double tip_length_mm = 3.0;     ///< straight, after the last segment
    double max_speed_mm_s = 100.0;  ///< fastest insertion and withdrawal
    double max_rotation_deg_s = 360.0;
    double bending_stiffness_n_mm2 = 200.0;  ///< EI of the steerable part; a stiffer guidewire inside leads it
    double friction = 0.1;                   ///< Coulomb coefficient against the wall
    double wire_friction = 0.1;              ///< the same against a guidewire that lies beside it, 0 .. 2
    double force_limit_n = 3.0;              ///< the sum of its contact forces beyond which it gives way (give_way.h)
    double tip_force_limit_n = 3.0;          ///< the same for the last 10 mm
    double penetration_limit_mm = 0.5;       ///< deepest predicted penetration that a command may cause
    std::string material = "polymer";
    std::string tip_material = "tungsten_polymer";  ///< of the marker band
    double tip_marker_length_mm = 2.0;              ///< of that band, measured from the tip; at most tip_length_mm
    std::string source;

    /// Which of the operator's bends segment i follows, with what its place says where it says nothing itself.
    std::string driven_by(std::size_t i) const;
    double radius_mm() const { return 0.5 * outer_diameter_mm; }
    /// Segments, links and tip together, mm.
    double steerable_length_mm() const;
};

/// Throws UserError that names the first number out of its range and the range.  `where` = the file, if there is one.
void validate(const CatheterSpec& spec, const SourcePlace& where = {});

}  // namespace cathlab
