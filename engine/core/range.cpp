#include "core/range.h"

#include <cmath>
#include <sstream>

namespace cathlab {

void require_range(const SourcePlace& where, const std::string& key, double value, double least, double most) {
    if (std::isfinite(value) && value >= least && value <= most) return;
    SourcePlace place = where;
    place.key = key;
    std::ostringstream text;
    text << "found " << value << ", allowed is " << least << " to " << most;
    throw UserError(place, text.str());
}

}  // namespace cathlab
