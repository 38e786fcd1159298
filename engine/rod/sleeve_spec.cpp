#include "rod/sleeve_spec.h"

#include <algorithm>
#include <sstream>

#include "core/errors.h"

namespace cathlab {
namespace {

[[noreturn]] void refuse(const SleeveSpec& sleeve, const std::string& key, double value, const std::string& why) {
    std::ostringstream text;
    text << "catheter '" << sleeve.name << "': " << key << " = " << value << ": " << why;
    throw UserError(text.str());
}

}  // namespace

WireSpec as_wire(const SleeveSpec& sleeve) {
    WireSpec wire;
    wire.name = sleeve.name;
    wire.length_mm = sleeve.length_mm;
    wire.link_length_mm = sleeve.link_length_mm;
    wire.sections = sleeve.sections;
    wire.friction = sleeve.friction;
    wire.max_push_n = sleeve.max_push_n;
    wire.max_speed = sleeve.max_speed;
    wire.source = sleeve.source;
    return wire;
}

void validate(const SleeveSpec& sleeve) {
    validate(as_wire(sleeve));
    if (!(sleeve.wire_friction >= 0.0 && sleeve.wire_friction <= 2.0))
        refuse(sleeve, "wire_friction", sleeve.wire_friction, "must lie between 0 and 2");
    double narrowest = sleeve.sections.front().diameter_mm;
    for (const WireSection& section : sleeve.sections) narrowest = std::min(narrowest, section.diameter_mm);
    if (!(sleeve.inner_diameter_mm >= 0.05 && sleeve.inner_diameter_mm < narrowest)) {
        std::ostringstream why;
        why << "must lie between 0.05 and the smallest outer diameter, " << narrowest << " mm";
        refuse(sleeve, "inner_diameter_mm", sleeve.inner_diameter_mm, why.str());
    }
}

void validate(const SleeveSpec& sleeve, const WireSpec& wire) {
    validate(sleeve);
    for (const WireSection& section : wire.sections)
        if (section.diameter_mm > sleeve.inner_diameter_mm) {
            std::ostringstream why;
            why << "the wire '" << wire.name << "' of " << section.diameter_mm << " mm does not go through it";
            refuse(sleeve, "inner_diameter_mm", sleeve.inner_diameter_mm, why.str());
        }
}

}  // namespace cathlab
