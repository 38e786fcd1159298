#include "hud/panels.h"

#include <imgui.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdarg>
#include <cstdio>

namespace cathlab {

namespace {

// Told apart by colour-blind eyes [okabe2008].
constexpr ImU32 calm = IM_COL32(0, 158, 115, 255);
constexpr ImU32 alarm = IM_COL32(230, 159, 0, 255);
constexpr ImU32 stop = IM_COL32(213, 94, 0, 255);
constexpr ImU32 ink = IM_COL32(235, 240, 244, 255);
constexpr ImU32 faint = IM_COL32(176, 186, 194, 255);
constexpr ImU32 shade = IM_COL32(8, 12, 16, 150);

std::string text(const char* format, ...) __attribute__((format(printf, 1, 2)));
std::string text(const char* format, ...) {
    std::array<char, 200> out{};
    va_list arguments;
    va_start(arguments, format);
    std::vsnprintf(out.data(), out.size(), format, arguments);
    va_end(arguments);
    return out.data();
}

class Pen {
public:
    Pen(ImDrawList* list, float scale) : list_(list), scale_(scale) {}
    float line() const { return 17 * scale_; }
    ImVec2 size(const std::string& s, float height = 14) const {
        return ImGui::GetFont()->CalcTextSizeA(height * scale_, 4096.0F, 0.0F, s.c_str());
    }
    // A dark copy behind the letters keeps them readable on lung and on spine.
    void put(float x, float y, ImU32 color, const std::string& s, float height = 14) const {
        const ImVec2 at(std::floor(x), std::floor(y));
        list_->AddText(ImGui::GetFont(), height * scale_, ImVec2(at.x + 1, at.y + 1), IM_COL32(0, 0, 0, 210),
                       s.c_str());
        list_->AddText(ImGui::GetFont(), height * scale_, at, color, s.c_str());
    }
    void put_right(float x, float y, ImU32 color, const std::string& s, float height = 14) const {
        put(x - size(s, height).x, y, color, s, height);
    }
    ImDrawList* list() const { return list_; }
    float scale() const { return scale_; }

private:
    ImDrawList* list_;
    float scale_;
};

void draw_picture_text(const Pen& pen, const HudData& d, const HudLayout& l) {
    const float m = 9 * l.scale, step = pen.line();
    pen.put(m, m, ink, primary_text(d.primary_deg) + "   " + secondary_text(d.secondary_deg), 16);
    pen.put(m, m + 1.3F * step, faint, text("SID %.0f  FD %.0f mm", d.sid_mm, d.field_mm), 12);
    pen.put(m, m + 2.2F * step, faint, text("%.0f kVp  %.3g p/s", d.kvp, d.pulses_per_s), 12);

    // Lamp: shape and word as well as colour.
    const std::string word =
        (d.acquisition.empty() ? "" : d.acquisition + "   ") + (d.beam_on ? "X-RAY ON" : "X-RAY OFF");
    const float lamp_x = l.split - m - 5 * l.scale;
    const ImVec2 lamp(lamp_x, m + 8 * l.scale);
    if (d.beam_on) {
        pen.list()->AddCircleFilled(lamp, 6 * l.scale, IM_COL32(240, 228, 66, 255), 24);
    } else {
        pen.list()->AddCircle(lamp, 6 * l.scale, faint, 24, 1.5F * l.scale);
    }
    pen.put_right(lamp_x - 11 * l.scale, m, d.beam_on ? IM_COL32(240, 228, 66, 255) : faint, word);

    const float base = l.height - m;
    pen.put(m, base - 3 * step, faint, text("beam-on %s", time_text(d.beam_on_s).c_str()), 12);
    pen.put(m, base - 2.1F * step, faint, text("%.2f mGy  %.1f mGy/min", d.air_kerma_mgy, d.air_kerma_rate_mgy_min),
            12);
    std::string dose = text("DAP %.3f Gy cm2", d.dose_area_gycm2);
    if (d.contrast_ml > 0) dose += text("  contrast %.1f mL", d.contrast_ml);
    pen.put(m, base - 1.2F * step, faint, dose, 12);
    // Beside the dose, or above it where the letters are large and the picture is narrow.
    const std::string warning = "SIMULATION - NOT FOR DIAGNOSIS";
    const bool room = pen.size(dose, 12).x + pen.size(warning, 12).x + 4 * m < l.split;
    if (room)
        pen.put_right(l.split - m, base - 1.25F * step, ink, warning, 12);
    else
        pen.put(m, base - 3.9F * step, ink, warning, 12);
}

// From the alarm on, a bar without colours is told apart by stripes.
void stripe(ImDrawList* list, const HudRect& r, float to, float step) {
    list->PushClipRect(ImVec2(r.x0, r.y0), ImVec2(to, r.y1), true);
    for (float x = r.x0; x < to + (r.y1 - r.y0); x += step)
        list->AddLine(ImVec2(x, r.y0), ImVec2(x - (r.y1 - r.y0), r.y1), IM_COL32(0, 0, 0, 255), 0.35F * step);
    list->PopClipRect();
}

void draw_force_bar(const Pen& pen, const HudForce& f, double alarm_share, bool plain, const HudRect& r) {
    const double share = std::clamp(f.force_n / std::max(1e-9, f.limit_n), 0.0, 1.0);
    const bool at_alarm = f.judged && share >= alarm_share, at_stop = f.judged && share >= 1.0;
    const ImU32 white = IM_COL32(255, 255, 255, 255);
    const ImU32 color = plain ? white : at_stop ? stop : (at_alarm ? alarm : calm);
    const ImU32 alarm_mark = plain ? white : alarm, stop_mark = plain ? white : stop;
    ImDrawList* list = pen.list();
    list->AddRectFilled(ImVec2(r.x0, r.y0), ImVec2(r.x1, r.y1), IM_COL32(48, 56, 62, 255));
    list->AddRectFilled(ImVec2(r.x0, r.y0), ImVec2(r.x0 + static_cast<float>(share) * (r.x1 - r.x0), r.y1), color);
    const float s = pen.scale();
    if (plain && at_alarm)
        stripe(list, r, r.x0 + static_cast<float>(share) * (r.x1 - r.x0), (at_stop ? 5.0F : 10.0F) * s);
    const float y = r.y0 - pen.line();
    pen.put(r.x0, y, f.judged ? ink : faint, f.name);
    if (!f.judged) {
        pen.put_right(r.x1 + 3 * s, y, faint, text("%.2f N", f.force_n));
        return;
    }
    const float mark = r.x0 + static_cast<float>(alarm_share) * (r.x1 - r.x0);
    list->AddLine(ImVec2(mark, r.y0 - 3 * s), ImVec2(mark, r.y1 + 3 * s), alarm_mark, 2 * s);
    list->AddRectFilled(ImVec2(r.x1, r.y0 - 4 * s), ImVec2(r.x1 + 3 * s, r.y1 + 4 * s), stop_mark);
    const std::string state = at_stop ? "STOP  " : (at_alarm ? "ALARM  " : "");
    pen.put_right(r.x1 + 3 * s, y, at_alarm ? color : ink, state + text("%.2f / %.2f N", f.force_n, f.limit_n));
}

}  // namespace

HudRect force_bar_rect(const HudLayout& layout, std::size_t count, std::size_t index) {
    const float s = layout.scale;
    const float bottom = layout.height - 26 * s - 40 * s * static_cast<float>(count - 1 - index);
    const float x0 = std::floor(layout.split + 16 * s), x1 = std::floor(layout.width - 19 * s);
    return {x0, std::floor(bottom - 13 * s), x1, std::floor(bottom)};
}

void draw_panels(const HudData& d, const HudLayout& l) {
    ImGui::SetNextWindowPos(ImVec2(0, 0));
    ImGui::SetNextWindowSize(ImVec2(l.width, l.height));
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(0, 0));
    ImGui::Begin("##panels", nullptr,
                 ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoBackground | ImGuiWindowFlags_NoInputs |
                     ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoBringToFrontOnFocus);
    const Pen pen(ImGui::GetWindowDrawList(), l.scale);
    draw_picture_text(pen, d, l);

    if (l.width - l.split > 150 * l.scale) {
        const float m = 9 * l.scale, step = pen.line();
        pen.put(l.split + m, m, ink, time_text(d.elapsed_s) + (d.running ? "" : "  PAUSED"), 16);
        if (!d.title.empty()) pen.put(l.split + m, m + 1.3F * step, faint, d.title, 12);
        std::string speed;
        if (d.frames_per_s > 0) speed += text("%.0f fps", d.frames_per_s);
        if (d.real_time_factor > 0) speed += text("  x%.1f", d.real_time_factor);
        pen.put_right(l.width - m, m, faint, speed, 12);

        const std::size_t count = d.forces.size();
        const std::size_t shown = std::min<std::size_t>(3, d.messages.size());
        const float bars_top = count > 0 ? force_bar_rect(l, count, 0).y0 - 1.6F * step : l.height - m;
        const float panel_top = bars_top - (d.insertion.empty() ? 0 : step) - 4 * l.scale;
        pen.list()->AddRectFilled(ImVec2(l.split + m, panel_top), ImVec2(l.width - m, l.height - m), shade,
                                  5 * l.scale);
        if (!d.insertion.empty()) pen.put(l.split + 16 * l.scale, bars_top - 0.8F * step, faint, d.insertion, 12);
        for (std::size_t i = 0; i < count; ++i)
            draw_force_bar(pen, d.forces[i], d.alarm_share, d.high_contrast, force_bar_rect(l, count, i));
        for (std::size_t i = 0; i < shown; ++i) {
            const float up = static_cast<float>(shown - i) + 0.3F;
            pen.put(l.split + 14 * l.scale, panel_top - up * step, ink, d.messages[d.messages.size() - shown + i], 13);
        }
    }
    ImGui::End();
    ImGui::PopStyleVar();
}

}  // namespace cathlab
