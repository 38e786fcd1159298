#include "hud/hud_data.h"

#include <array>
#include <cmath>
#include <cstdio>

namespace cathlab {

std::string primary_text(double primary_deg) {
    const long angle = std::lround(primary_deg);
    if (angle == 0) return "AP 0";
    return (angle > 0 ? "LAO " : "RAO ") + std::to_string(std::labs(angle));
}

std::string secondary_text(double secondary_deg) {
    const long angle = std::lround(secondary_deg);
    return (angle >= 0 ? "CRAN " : "CAUD ") + std::to_string(std::labs(angle));
}

std::string time_text(double seconds) {
    const auto tenths = static_cast<long>(std::floor(std::fmax(0.0, seconds) * 10 + 1e-6));
    std::array<char, 32> text{};
    std::snprintf(text.data(), text.size(), "%ld:%02ld.%ld", tenths / 600, tenths / 10 % 60, tenths % 10);
    return text.data();
}

}  // namespace cathlab
