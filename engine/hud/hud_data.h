// What the panels show, as plain numbers: filled by whoever knows the world.
#pragma once

#include <string>
#include <vector>

namespace cathlab {

/// One bar.  The bar's full length is the limit.  One that is judged has an alarm mark at alarm_share of it and a stop
/// mark at its end, and takes their colours; any other is a plain reading.
struct HudForce {
    std::string name;
    double force_n = 0;
    double limit_n = 0.8;
    bool judged = true;
};

struct HudData {
    std::string title;  ///< scene
    double elapsed_s = 0;
    bool running = true;

    double primary_deg = 0;    ///< + LAO, - RAO (DICOM)
    double secondary_deg = 0;  ///< + cranial, - caudal (DICOM)
    double sid_mm = 0;
    double field_mm = 0;  ///< side of the field of view at the detector
    bool beam_on = false;
    std::string acquisition;  ///< "", "CINE", "DSA" or "ROADMAP": what is not plain fluoroscopy
    double kvp = 0;
    double pulses_per_s = 0;
    double beam_on_s = 0;
    double air_kerma_mgy = 0;  ///< cumulative, at the reference point
    double air_kerma_rate_mgy_min = 0;
    double dose_area_gycm2 = 0;
    double contrast_ml = 0;

    std::vector<HudForce> forces;
    double alarm_share = 0.7;
    std::string insertion;              ///< "wire 412 mm  catheter 300 mm"
    std::vector<std::string> messages;  ///< newest last
    double frames_per_s = 0;
    double real_time_factor = 0;
    bool high_contrast = false;  ///< white, grey and hatched bars instead of colours
};

/// "LAO 30", "RAO 12", "AP 0" from DICOM's signed angle (nearest whole degree); likewise "CRAN 25", "CAUD 10", "CRAN
/// 0".
std::string primary_text(double primary_deg);
std::string secondary_text(double secondary_deg);
/// "3:07.4"
std::string time_text(double seconds);

}  // namespace cathlab
