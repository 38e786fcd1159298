// Inside the engine: mm, kg, s, hence mN, kPa, uJ.  These constants are the only way in and out.
#pragma once

namespace cathlab::units {

inline constexpr double pi = 3.14159265358979323846;
inline constexpr double deg = pi / 180.0;       // degrees -> radians
inline constexpr double newton = 1000.0;        // N -> mN
inline constexpr double metre = 1000.0;         // m -> mm
inline constexpr double mpa = 1000.0;           // MPa -> kPa
inline constexpr double mmhg = 0.133322387415;  // mmHg -> kPa
inline constexpr double gram_per_cm3 = 1e-6;    // g/cm3 -> kg/mm3
inline constexpr double gravity = 9806.65;      // standard gravity, mm/s2
inline constexpr double french = 1.0 / 3.0;     // catheter size Fr -> outer diameter in mm
inline constexpr double inch = 25.4;            // in -> mm

}  // namespace cathlab::units
