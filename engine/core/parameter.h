// A named number with unit, default, range and a sentence: the one description from which scene files, the JSON Schema,
// `cathlab list`, the calibrator and the docs are made.
#pragma once

#include <string_view>

namespace cathlab {

struct Parameter {
    std::string_view key;   ///< snake_case, carries its unit unless that is one of mm, kg, s, mN, kPa
    std::string_view unit;  ///< "mm", "deg", "1" for a pure number
    double default_value = 0.0;
    double minimum = 0.0;  ///< inclusive
    double maximum = 0.0;  ///< inclusive
    std::string_view doc;
};

}  // namespace cathlab
