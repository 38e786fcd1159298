// Views of the C-arm that have a name.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace cathlab {

/// Angles by DICOM's signs: primary + = LAO, secondary + = cranial; deg.
struct ViewPreset {
    std::string_view name;  ///< as scenes, scripts and the command line spell it
    double primary_deg = 0.0;
    double secondary_deg = 0.0;
    std::string_view shows;  ///< what it is taken for
};

/// In the order in which a list shows them.  The middles of the ranges in use: [dimario2005] for the coronary views,
/// [dicom-ps3.3] for the signs.
std::span<const ViewPreset> view_presets();

/// nullptr where there is none of that name.
const ViewPreset* find_view(std::string_view name);

/// The one that has these angles (to 0.5 deg), or nullptr.
const ViewPreset* view_at(double primary_deg, double secondary_deg);

/// The one after it in the list; the first where these angles have no name.
const ViewPreset& view_after(double primary_deg, double secondary_deg);

/// For an error's list.
std::vector<std::string> view_names();

}  // namespace cathlab
