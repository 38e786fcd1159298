#include "rod/wire_spec.h"

#include <cmath>
#include <sstream>

#include "core/errors.h"

namespace cathlab {
namespace {

constexpr double most_links = 4000.0;

// Refuses NaN as well: every comparison with it is false.
void need(const WireSpec& spec, const std::string& key, double value, double low, double high, const char* unit) {
    if (value >= low && value <= high) return;
    std::ostringstream text;
    text << "wire '" << spec.name << "': " << key << " = " << value << ": must lie between " << low << " and " << high;
    if (*unit != '\0') text << " " << unit;
    throw UserError(text.str());
}

void check_section(const WireSpec& spec, std::size_t index) {
    const WireSection& s = spec.sections[index];
    const std::string at = "sections[" + std::to_string(index) + "].";
    const bool last = index + 1 == spec.sections.size();
    if (!last) need(spec, at + "length_mm", s.length_mm, 0.2, 1e4, "mm");
    need(spec, at + "diameter_mm", s.diameter_mm, 0.05, 10.0, "mm");
    need(spec, at + "bending_stiffness_n_mm2", s.bending_stiffness_n_mm2, 1e-3, 1e6, "N mm2");
    need(spec, at + "torsion_stiffness_n_mm2", s.torsion_stiffness_n_mm2, 1e-3, 1e6, "N mm2");
    need(spec, at + "axial_stiffness_n", s.axial_stiffness_n, 1.0, 1e7, "N");
    need(spec, at + "density_kg_m3", s.density_kg_m3, 100.0, 25000.0, "kg/m3");
    need(spec, at + "rest_curvature_per_mm", s.rest_curvature_per_mm, -1.0, 1.0, "1/mm");
    if (s.link_length_mm != 0.0) need(spec, at + "link_length_mm", s.link_length_mm, 0.2, 50.0, "mm (or 0)");
}

}  // namespace

void validate(const WireSpec& spec) {
    need(spec, "length_mm", spec.length_mm, 5.0, 1e4, "mm");
    need(spec, "link_length_mm", spec.link_length_mm, 0.2, 50.0, "mm");
    need(spec, "friction", spec.friction, 0.0, 2.0, "");
    need(spec, "max_push_n", spec.max_push_n, 1e-3, 1e3, "N");
    need(spec, "max_speed", spec.max_speed, 1e-3, 1e3, "mm/s");
    need(spec, "damping_per_s", spec.damping_per_s, 0.0, 1e5, "1/s");
    need(spec, "spin_damping_per_s", spec.spin_damping_per_s, 0.0, 1e5, "1/s");
    if (spec.sections.empty()) throw UserError("wire '" + spec.name + "': sections: at least one is needed");
    double before_last = 0.0;
    for (std::size_t i = 0; i < spec.sections.size(); ++i) {
        check_section(spec, i);
        if (i + 1 < spec.sections.size()) before_last += spec.sections[i].length_mm;
    }
    if (before_last > spec.length_mm - 0.2) {
        std::ostringstream text;
        text << "wire '" << spec.name << "': length_mm = " << spec.length_mm
             << ": the sections before the last one take " << before_last
             << " mm, which leaves nothing for the last; make the wire longer or a section shorter";
        throw UserError(text.str());
    }
    double links = 0.0;
    for (std::size_t i = 0; i < spec.sections.size(); ++i) {
        const WireSection& section = spec.sections[i];
        const double length = i + 1 < spec.sections.size() ? section.length_mm : spec.length_mm - before_last;
        links += std::ceil(length / (section.link_length_mm > 0.0 ? section.link_length_mm : spec.link_length_mm));
    }
    if (links > most_links) {
        std::ostringstream text;
        text << "wire '" << spec.name << "': link_length_mm = " << spec.link_length_mm << ": makes " << links
             << " links of it, at most " << most_links << " are allowed; take longer links";
        throw UserError(text.str());
    }
    if (spec.length_mm < 4.0 * spec.link_length_mm) {
        std::ostringstream text;
        text << "wire '" << spec.name << "': link_length_mm = " << spec.link_length_mm << ": a wire of "
             << spec.length_mm << " mm needs at least four links, so at most " << spec.length_mm / 4.0 << " mm each";
        throw UserError(text.str());
    }
}

}  // namespace cathlab
