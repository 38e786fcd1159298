#include "catheter/spec.h"

#include "core/range.h"

namespace cathlab {

double CatheterSpec::steerable_length_mm() const {
    double length = tip_length_mm;
    for (const CatheterSegment& segment : segments) length += segment.length_mm;
    if (segments.size() > 1) length += link_length_mm * static_cast<double>(segments.size() - 1);
    return length;
}

std::string CatheterSpec::driven_by(std::size_t i) const {
    if (!segments.at(i).driven_by.empty()) return segments[i].driven_by;
    if (i == 0) return "proximal";
    return i + 1 == segments.size() ? "distal" : "none";
}

void validate(const CatheterSpec& spec, const SourcePlace& where) {
    require_range(where, "outer_diameter_mm", spec.outer_diameter_mm, 0.3, 10.0);
    require_range(where, "inner_diameter_mm", spec.inner_diameter_mm, 0.0, spec.outer_diameter_mm);
    require_range(where, "segments (how many)", static_cast<double>(spec.segments.size()), 1.0, 8.0);
    for (const CatheterSegment& segment : spec.segments) {
        const std::string key = "segment '" + segment.name + "' ";
        require_range(where, key + "length_mm", segment.length_mm, 1.0, 300.0);
        require_range(where, key + "max_bend_deg", segment.max_bend_deg, 0.0, 180.0);
        require_range(where, key + "max_rate_deg_s", segment.max_rate_deg_s, 0.1, 1000.0);
        const std::string& by = segment.driven_by;
        if (!by.empty() && by != "proximal" && by != "distal" && by != "none")
            throw UserError(where, key + "driven_by: found '" + by + "', allowed are proximal, distal, none");
    }
    require_range(where, "link_length_mm", spec.link_length_mm, 0.0, 100.0);
    require_range(where, "tip_length_mm", spec.tip_length_mm, 0.0, 100.0);
    require_range(where, "tip_marker_length_mm", spec.tip_marker_length_mm, 0.0, spec.tip_length_mm);
    require_range(where, "length_mm", spec.length_mm, spec.steerable_length_mm(), 3000.0);
    require_range(where, "max_speed_mm_s", spec.max_speed_mm_s, 0.1, 1000.0);
    require_range(where, "max_rotation_deg_s", spec.max_rotation_deg_s, 0.1, 3600.0);
    require_range(where, "friction", spec.friction, 0.0, 2.0);
    require_range(where, "wire_friction", spec.wire_friction, 0.0, 2.0);
    require_range(where, "bending_stiffness_n_mm2", spec.bending_stiffness_n_mm2, 0.1, 1e6);
    require_range(where, "force_limit_n", spec.force_limit_n, 0.001, 100.0);
    require_range(where, "tip_force_limit_n", spec.tip_force_limit_n, 0.001, 100.0);
    require_range(where, "penetration_limit_mm", spec.penetration_limit_mm, 0.001, 10.0);
}

}  // namespace cathlab
