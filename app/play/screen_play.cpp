#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "beam/view_presets.h"
#include "hud/hud_data.h"
#include "play/screens.h"
#include "play/view_projection.h"

namespace cathlab::play {
namespace {

constexpr ImGuiWindowFlags bare = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                                  ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoFocusOnAppearing |
                                  ImGuiWindowFlags_NoNav | ImGuiWindowFlags_NoBringToFrontOnFocus;
constexpr ImU32 goal_color = IM_COL32(86, 180, 233, 255), held_color = IM_COL32(0, 158, 115, 255);
constexpr ImU32 ink = IM_COL32(235, 240, 244, 255);

void place(const FrameRect& r) {
    ImGui::SetNextWindowPos(ImVec2(static_cast<float>(r.x), static_cast<float>(r.y)));
    ImGui::SetNextWindowSize(ImVec2(static_cast<float>(r.width), static_cast<float>(r.height)));
}

std::string angles_text(double primary_deg, double secondary_deg) {
    char text[64];
    std::snprintf(text, sizeof text, "%s %.0f", primary_deg < 0.0 ? "RAO" : "LAO", std::fabs(primary_deg));
    std::string out = text;
    if (secondary_deg == 0.0) return out;
    std::snprintf(text, sizeof text, ", %s %.0f", secondary_deg < 0.0 ? "CAUD" : "CRAN", std::fabs(secondary_deg));
    return out + text;
}

void shadowed(ImDrawList* list, ImVec2 at, ImU32 color, const std::string& text) {
    at = ImVec2(std::floor(at.x), std::floor(at.y));
    list->AddText(ImVec2(at.x + 1, at.y + 1), IM_COL32(0, 0, 0, 210), text.c_str());
    list->AddText(at, color, text.c_str());
}

// Where the tip is to go: a ring in the picture, or an arrow at its edge.
void draw_goal(const PlayView& view, const ScreenLayout& layout) {
    const GoalView& goal = view.status.goal;
    if (!goal.present || view.difficulty != Difficulty::guided) return;
    const auto at = place_on_picture(view.status.view, goal.position);
    if (!at) return;
    const FrameRect& r = layout.fluoroscopy;
    const auto side = static_cast<float>(r.width);
    const ImVec2 origin(static_cast<float>(r.x), static_cast<float>(r.y));
    ImDrawList* list = ImGui::GetBackgroundDrawList();
    const ImU32 color = goal.inside ? held_color : goal_color;
    const float margin = 2.0F * layout.em;
    const ImVec2 p(origin.x + static_cast<float>(at->x()) * side, origin.y + static_cast<float>(at->y()) * side);
    const ImVec2 in(std::clamp(p.x, origin.x + margin, origin.x + side - margin),
                    std::clamp(p.y, origin.y + 3.5F * margin, origin.y + side - 3.5F * margin));
    const bool visible = std::fabs(p.x - in.x) + std::fabs(p.y - in.y) < 1.0F;
    if (!visible) {
        const float dx = p.x - in.x, dy = p.y - in.y, n = std::max(1.0F, std::hypot(dx, dy));
        const ImVec2 tip(in.x + dx / n * layout.em, in.y + dy / n * layout.em);
        const ImVec2 side_ways(-dy / n * 0.5F * layout.em, dx / n * 0.5F * layout.em);
        list->AddTriangleFilled(tip, ImVec2(in.x + side_ways.x, in.y + side_ways.y),
                                ImVec2(in.x - side_ways.x, in.y - side_ways.y), color);
        shadowed(list, ImVec2(in.x + 0.9F * layout.em, in.y - 0.5F * layout.em), color, "goal");
        return;
    }
    const double seen = (view.status.view.detector_center - view.status.view.source).norm() /
                        std::max(1.0, (goal.position - view.status.view.source).norm());
    const float radius =
        std::max(0.6F * layout.em, static_cast<float>(goal.radius_mm * seen / view.status.view.width_mm) * side);
    list->AddCircle(p, radius, color, 48, 2.0F);
    if (goal.inside && goal.hold_s > 0.0) {
        const auto share = static_cast<float>(std::clamp(goal.held_s / goal.hold_s, 0.0, 1.0));
        list->PathArcTo(p, radius + 5.0F, -1.5708F, -1.5708F + 6.2832F * share, 40);
        list->PathStroke(held_color, 0, 4.0F);
    }
    shadowed(list, ImVec2(p.x + radius + 6.0F, p.y - 0.5F * layout.em), color, goal.inside ? "hold" : "goal");
}

void draw_time_line(const PlayView& view, PlayWishes& wishes) {
    int step = static_cast<int>(view.status.steps);
    char text[64];
    std::snprintf(text, sizeof text, "%s of %s", time_text(view.status.channels.time_s).c_str(),
                  time_text(view.replay_s).c_str());
    ImGui::SetNextItemWidth(-1.0F);
    if (ImGui::SliderInt("##time", &step, 0, static_cast<int>(std::max<std::int64_t>(1, view.status.replay_steps)),
                         text))
        wishes.seek(step);
}

void draw_device_row(const PlayView& view, PlayWishes& wishes) {
    const Status& s = view.status;
    if (s.has_wire) {
        if (ImGui::RadioButton("wire", !s.catheter)) wishes.press(Control::wire);
        ImGui::SameLine();
    }
    if (s.has_catheter) {
        const char* segment = s.segment == 1 ? "catheter, distal" : "catheter, proximal";
        if (ImGui::RadioButton(s.catheter ? segment : "catheter", s.catheter)) wishes.press(Control::catheter);
        ImGui::SameLine();
    }
    bool jog = s.jog, follows = s.follows;
    if (ImGui::Checkbox("1 mm steps", &jog)) wishes.press(Control::jog);
    ImGui::SameLine();
    if (ImGui::Checkbox("table follows", &follows)) wishes.press(Control::follow);
}

// The C-arm's angle by name, and the picture that stays.
void draw_arm_row(const PlayView& view, const ScreenLayout& layout, PlayWishes& wishes) {
    const Input& input = view.status.input;
    const ViewPreset* here = view_at(input.primary_angle, input.secondary_angle);
    ImGui::TextDisabled(view.status.moves_table ? "D-pad: table" : "C-arm");
    ImGui::SameLine();
    ImGui::SetNextItemWidth(9.0F * layout.em);
    if (ImGui::BeginCombo("##view", here == nullptr ? "by hand" : spoken(std::string(here->name)).c_str())) {
        for (const ViewPreset& preset : view_presets()) {
            const std::string text =
                spoken(std::string(preset.name)) + ": " + angles_text(preset.primary_deg, preset.secondary_deg);
            if (ImGui::Selectable(text.c_str(), &preset == here))
                wishes.turn_to(preset.primary_deg, preset.secondary_deg);
            if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", preset.shows.data());
        }
        ImGui::EndCombo();
    }
    ImGui::SameLine();
    if (ImGui::Button("Keep picture")) wishes.press(Control::reference);
}

// What the pedal exposes.
void draw_series_row(const PlayView& view, const ScreenLayout& layout, PlayWishes& wishes) {
    const Input& input = view.status.input;
    const char* names[] = {"fluoro", "cine", "DSA"};
    for (int i = 0; i < 3; ++i) {
        if (ImGui::RadioButton(names[i], std::lround(input.acquisition) == i)) wishes.acquire(i);
        ImGui::SameLine();
    }
    bool roadmap = input.roadmap > 0.5;
    ImGui::BeginDisabled(!view.roadmap_allowed);
    if (ImGui::Checkbox("roadmap", &roadmap)) wishes.press(Control::roadmap);
    ImGui::EndDisabled();
    const char* doses[] = {"low dose", "normal dose", "high dose"};
    const int level = std::clamp(static_cast<int>(std::lround(input.fluoroscopy_level)), 0, 2);
    ImGui::SetNextItemWidth(7.5F * layout.em);
    if (ImGui::BeginCombo("##dose", doses[level])) {
        for (int i = 0; i < 3; ++i)
            if (ImGui::Selectable(doses[i], i == level)) wishes.set_level(i);
        ImGui::EndCombo();
    }
    ImGui::SameLine();
    ImGui::TextDisabled("blades");
    auto wide = static_cast<float>(100.0 * input.collimator_width);
    auto high = static_cast<float>(100.0 * input.collimator_height);
    bool moved = false;
    for (float* share : {&wide, &high}) {
        ImGui::SameLine();
        ImGui::SetNextItemWidth(5.5F * layout.em);
        moved = ImGui::SliderFloat(share == &wide ? "##wide" : "##high", share, 10.0F, 100.0F,
                                   share == &wide ? "wide %.0f %%" : "high %.0f %%") ||
                moved;
    }
    if (moved) wishes.open_to(0.01 * static_cast<double>(wide), 0.01 * static_cast<double>(high));
}

void draw_state(const PlayView& view, const Bindings& bindings) {
    const Status& s = view.status;
    std::string line;
    char text[160];
    if (s.goal.present) {
        std::snprintf(text, sizeof text, "%.0f mm to the goal, %s left", s.goal.distance_mm,
                      time_text(s.goal.left_s).c_str());
        line = s.goal.inside ? "in the goal: hold still" : text;
    }
    if (!line.empty()) ImGui::TextUnformatted(line.c_str());
    std::snprintf(text, sizeof text, "x%.2g%s", s.time_scale, s.paused ? ", paused" : "");
    line = view.replay ? "replay" : view.recording ? "recording" : "not recorded";
    line += std::string("   time ") + text;
    if (view.latency_ms > 0.0) {
        std::snprintf(text, sizeof text, "   hand to picture %.0f ms", view.latency_ms);
        line += text;
    }
    ImGui::TextDisabled("%s", line.c_str());
    if (s.behind) {
        std::snprintf(text, sizeof text, "This machine cannot keep the pace: x%.2f of real time", s.real_time_factor);
        ImGui::TextUnformatted(text);
    }
    const std::string keys = bindings.labels(Control::help, false);
    if (!keys.empty()) ImGui::TextDisabled("%s: controls", keys.c_str());
}

// Every control for the mouse alone.
void draw_hands(const ScreenLayout& layout, PlayWishes& wishes) {
    const FrameRect& r = layout.fluoroscopy;
    ImGui::SetNextWindowPos(ImVec2(static_cast<float>(r.x) + layout.em, static_cast<float>(r.y) + 5.0F * layout.em));
    ImGui::Begin("hands", nullptr, bare | ImGuiWindowFlags_AlwaysAutoResize);
    for (const ControlInfo& info : control_table()) {
        ImGui::PushID(static_cast<int>(info.control));
        const auto held = [&](const char* text, double value) {
            ImGui::Button(text, ImVec2(2.0F * layout.em, 0.0F));
            if (ImGui::IsItemActive()) wishes.hold(info.control, value);
        };
        if (info.kind == ControlKind::axis) {
            held("-", -1.0);
            ImGui::SameLine();
            held("+", 1.0);
        } else if (info.kind == ControlKind::hold) {
            ImGui::Button("hold", ImVec2(4.5F * layout.em, 0.0F));
            if (ImGui::IsItemActive()) wishes.hold(info.control, 1.0);
        }
        if (info.kind != ControlKind::press) {
            ImGui::SameLine();
            ImGui::TextUnformatted(info.label.data());
        }
        ImGui::PopID();
    }
    ImGui::End();
}

// From the bottom of the picture upward, the newest lowest, above the dose.
void draw_toasts(const PlayView& view, const ScreenLayout& layout) {
    ImDrawList* list = ImGui::GetForegroundDrawList();
    const FrameRect& r = layout.fluoroscopy;
    const float gap = 0.35F * layout.em;
    float y = static_cast<float>(r.y + r.height) - std::max(5.5F * layout.em, layout.foot);
    for (auto toast = view.toasts.rbegin(); toast != view.toasts.rend(); ++toast) {
        const float wrap = 0.85F * static_cast<float>(r.width);
        const ImVec2 size = ImGui::GetFont()->CalcTextSizeA(layout.em, 4096.0F, wrap, toast->c_str());
        const float x = static_cast<float>(r.x) + 0.5F * (static_cast<float>(r.width) - size.x);
        y -= size.y + 2.0F * gap;
        list->AddRectFilled(ImVec2(x - 2.0F * gap, y - gap), ImVec2(x + size.x + 2.0F * gap, y + size.y + gap),
                            IM_COL32(8, 12, 16, 225), 5.0F);
        list->AddText(ImGui::GetFont(), layout.em, ImVec2(x, y), ink, toast->c_str(), nullptr, wrap);
        y -= gap;
    }
}

}  // namespace

void draw_play(const PlayView& view, const ScreenLayout& layout, const Bindings& bindings, PlayWishes& wishes) {
    draw_goal(view, layout);
    if (layout.side.height > 0 && !view.side_title.empty())
        shadowed(ImGui::GetBackgroundDrawList(),
                 ImVec2(static_cast<float>(layout.side.x + layout.side.width) - layout.em * 0.6F -
                            ImGui::CalcTextSize(view.side_title.c_str()).x,
                        static_cast<float>(layout.side.y + layout.side.height) - 1.5F * layout.em),
                 ink, view.side_title);
    if (layout.panel.height > 0) {
        place(layout.panel);
        ImGui::Begin("panel", nullptr, (bare & ~ImGuiWindowFlags_NoScrollbar) | ImGuiWindowFlags_NoBackground);
        if (view.replay)
            draw_time_line(view, wishes);
        else {
            draw_device_row(view, wishes);
            draw_arm_row(view, layout, wishes);
            draw_series_row(view, layout, wishes);
        }
        draw_state(view, bindings);
        ImGui::SameLine();
        if (ImGui::SmallButton("Menu")) wishes.menu = true;
        if (!view.replay) {
            ImGui::SameLine();
            if (ImGui::SmallButton("Mouse")) wishes.hands = true;
        }
        ImGui::End();
    }
    if (view.hands_open && !view.replay) draw_hands(layout, wishes);
    draw_toasts(view, layout);
}

}  // namespace cathlab::play
