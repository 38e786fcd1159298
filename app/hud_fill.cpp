#include "hud_fill.h"

#include <cmath>

#include "core/units.h"

namespace cathlab {

void fill_hud(const SceneSpec& scene, const Channels& c, HudData& out) {
    out.title = scene.title.empty() ? scene.name : scene.title;
    out.elapsed_s = c.time_s;
    out.primary_deg = c.primary_angle_deg;
    out.secondary_deg = c.secondary_angle_deg;
    out.sid_mm = scene.c_arm.sid_mm;
    out.field_mm = scene.c_arm.field_of_view_mm;
    out.beam_on = c.beam_on > 0.5;
    out.acquisition = c.acquisition >= 1.5 ? "DSA" : c.acquisition >= 0.5 ? "CINE" : c.roadmap >= 0.5 ? "ROADMAP" : "";
    out.kvp = c.tube_voltage_kvp;
    out.pulses_per_s = scene.c_arm.frame_rate;
    out.beam_on_s = c.beam_time_s;
    out.air_kerma_mgy = c.air_kerma_mgy;
    out.air_kerma_rate_mgy_min = c.beam_time_s > 0.0 ? 60.0 * c.air_kerma_mgy / c.beam_time_s : 0.0;
    out.dose_area_gycm2 = c.dose_area_product_gycm2;
    out.contrast_ml = c.contrast_injected_ml;
    out.forces.clear();
    // The bar that the paper's rule fills and judges, then what each device presses with as a whole.
    out.forces.push_back({"force bar", c.force_bar_n, c.force_limit_n, true});
    if (scene.wire.enabled)
        out.forces.push_back({"wire, whole shaft", c.wire_force_mn / units::newton, c.force_limit_n, false});
    if (scene.catheter.enabled)
        out.forces.push_back({"catheter, whole shaft", c.catheter_force_mn / units::newton, c.force_limit_n, false});
    out.insertion.clear();
    const auto insertion = [&](const char* name, double mm) {
        out.insertion +=
            (out.insertion.empty() ? "" : "  ") + std::string(name) + " " + std::to_string(std::lround(mm)) + " mm";
    };
    if (scene.wire.enabled) insertion("wire", c.wire_insertion_mm);
    if (scene.catheter.enabled) insertion("catheter", c.catheter_insertion_mm);
}

}  // namespace cathlab
