// A view other than the scene's or the operator's: what `cathlab render` asks for.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace cathlab {

/// Unset: as it was.
struct ViewChange {
    std::optional<double> primary_deg, secondary_deg;  ///< + LAO, + cranial; held for the whole film
    std::optional<double> sid_mm, sod_mm, field_mm;
    std::optional<double> open_width, open_height;  ///< of the collimator, shares of the field
    std::optional<double> kerma_ngy;                ///< at the detector, a picture
    std::optional<double> kvp;
    std::string detector;           ///< "" = the scene's
    std::vector<double> isocentre;  ///< empty, or x, y, z in the patient, mm
    std::string third_person;       ///< "" = without, else what colours its wall: "force" or "displacement"
    bool alone = false;             ///< the fluoroscopy without inner view and panels
    double from_s = 0.0;            ///< of the first picture
    bool beam_on = false;           ///< every picture is exposed, whether the pedal was down or not

    /// Another place of source or detector: the exposure that the control chose belongs to the old one.
    bool moves() const { return primary_deg || secondary_deg || sid_mm || sod_mm || field_mm || !isocentre.empty(); }
};

}  // namespace cathlab
