// The text of engine/beam/attenuation_table.inl as xraylib gives it: what the printer prints and the test compares.
#pragma once

#include <xraylib.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <string>

namespace cathlab::xraylib {

inline constexpr int grid_size = 42;
inline constexpr std::array<int, 30> elements = {1,  6,  7,  8,  9,  11, 12, 13, 14, 15, 16, 17, 18, 19, 20,
                                                 22, 24, 25, 26, 28, 29, 30, 42, 53, 55, 56, 74, 78, 79, 83};

/// Total mass attenuation coefficient, cm2/g.
inline double total(int atomic_number, double energy_kev) {
    return CS_Total(atomic_number, energy_kev, nullptr);
}

/// Straight on in logarithms from `away` and half of it to the energy itself: xraylib's own curve jumps at a K edge a
/// little to one side of the edge's energy.
inline double one_sided(int atomic_number, double energy_kev, double away_kev) {
    const double near = energy_kev + 0.5 * away_kev, far = energy_kev + away_kev;
    const double slope = std::log(total(atomic_number, far) / total(atomic_number, near)) / std::log(far / near);
    return total(atomic_number, near) * std::pow(energy_kev / near, slope);
}

inline std::string number(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.6g", value);
    return text;
}

/// One element's row, wrapped at 120 columns.
inline std::string attenuation_row(int atomic_number) {
    const double edge = EdgeEnergy(atomic_number, K_SHELL, nullptr);
    const bool inside = edge > 20.0 && edge < 150.0;
    std::string text = "{" + std::to_string(atomic_number) + ", ";
    if (inside)
        text += number(edge) + ", " + number(one_sided(atomic_number, edge, -0.07)) + ", " +
                number(one_sided(atomic_number, edge, 0.07));
    else
        text += "0, 0, 0";
    text += ", {{\n";
    std::string line = "   ";
    for (int k = 0; k < grid_size; ++k) {
        const double energy = 20.0 * std::exp(0.05 * k);
        // An edge just below the first energy: its number is carried back from above.
        const bool at_edge = k == 0 && std::fabs(edge - energy) < 0.1;
        const std::string value =
            number(at_edge ? one_sided(atomic_number, energy, 0.01) : total(atomic_number, energy)) +
            (k + 1 < grid_size ? "," : "");
        if (line.size() + 1 + value.size() > 118) {
            text += line + "\n";
            line = "   ";
        }
        line += " " + value;
    }
    return text + line + "}}},\n";
}

inline std::string attenuation_table() {
    std::string text =
        "// Total mass attenuation of the elements, cm2/g, at 20 exp(0.05 k) keV, k = 0..41, and on either side of the "
        "K\n"
        "// edge where that lies in between.  Printed from xraylib (CS_Total) [schoonjans2011] by\n"
        "//   tests/print_attenuation_table > engine/beam/attenuation_table.inl      (in the build's folder)\n"
        "// and compared with it by tests/beam/xraylib_test.cpp.  Molybdenum's first number is carried back from above "
        "its\n// K edge, which lies just below 20 keV.\n"
        "// Z, K edge in keV (0 = outside), below it, above it, {grid}\n"
        "// clang-format off\n";
    for (const int z : elements) text += attenuation_row(z);
    return text + "// clang-format on\n";
}

}  // namespace cathlab::xraylib
