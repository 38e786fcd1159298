#include "beam/view_presets.h"

#include <array>
#include <cmath>

namespace cathlab {
namespace {

constexpr std::array<ViewPreset, 12> presets{{
    {"ap", 0, 0, "from the front: aorta, iliac arteries"},
    {"arch", 45, 0, "aortic arch unrolled, neck vessels apart"},
    {"root", 35, 0, "aortic root and valve"},
    {"left_main", 37, 22, "ostium of the left coronary artery"},
    {"spider", 45, -30, "left main and its division, seen from below"},
    {"rao_caudal", -35, -35, "circumflex artery"},
    {"rao_cranial", -30, 30, "left anterior descending artery and its diagonal branches"},
    {"ap_caudal", -5, -30, "left main, circumflex artery"},
    {"ap_cranial", -5, 40, "left anterior descending artery"},
    {"lao_cranial", 38, 30, "left anterior descending artery, end of the right coronary artery"},
    {"rca", 50, 0, "right coronary artery"},
    {"lateral", 90, 0, "from the left side"},
}};

}  // namespace

std::span<const ViewPreset> view_presets() {
    return presets;
}

const ViewPreset* find_view(std::string_view name) {
    for (const ViewPreset& preset : presets)
        if (preset.name == name) return &preset;
    return nullptr;
}

const ViewPreset* view_at(double primary_deg, double secondary_deg) {
    constexpr double near_deg = 0.5;
    for (const ViewPreset& preset : presets)
        if (std::fabs(preset.primary_deg - primary_deg) < near_deg &&
            std::fabs(preset.secondary_deg - secondary_deg) < near_deg)
            return &preset;
    return nullptr;
}

const ViewPreset& view_after(double primary_deg, double secondary_deg) {
    const ViewPreset* here = view_at(primary_deg, secondary_deg);
    return here == nullptr || here == &presets.back() ? presets.front() : *(here + 1);
}

std::vector<std::string> view_names() {
    std::vector<std::string> out;
    for (const ViewPreset& preset : presets) out.emplace_back(preset.name);
    return out;
}

}  // namespace cathlab
