#include <imgui.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "hud/hud_data.h"
#include "play/screens.h"

namespace cathlab::play {
namespace {

constexpr ImU32 own_color = IM_COL32(86, 180, 233, 255), expert_color = IM_COL32(230, 159, 0, 255);

// What the trainee reads first; the rest is in metrics.json.
constexpr std::array<std::string_view, 12> shown_metrics{"play_time_s",
                                                         "idle_time_s",
                                                         "fluoroscopy_time_s",
                                                         "air_kerma_mgy",
                                                         "contrast_ml",
                                                         "force_max_n",
                                                         "force_mean_n",
                                                         "force_bar_max",
                                                         "time_above_limit_s",
                                                         "contacts",
                                                         "accumulated_collision_n",
                                                         "wire_path_mm"};

void draw_metrics(const ResultView& view) {
    const int columns = view.expert ? 3 : 2;
    if (!ImGui::BeginTable("metrics", columns, ImGuiTableFlags_RowBg | ImGuiTableFlags_SizingStretchProp)) return;
    ImGui::TableSetupColumn("", 0, 0.52F);
    ImGui::TableSetupColumn("you", 0, 0.24F);
    if (view.expert) {
        ImGui::TableSetupColumn("expert", 0, 0.24F);
        ImGui::TableHeadersRow();
    }
    for (const std::string_view name : shown_metrics) {
        const MetricInfo* info = find_metric(name);
        if (info == nullptr) continue;
        ImGui::TableNextRow();
        ImGui::TableNextColumn();
        std::string label = spoken(std::string(info->name));
        for (const char* unit : {" s", " mgy", " ml", " n", " mm"})
            if (label.ends_with(unit)) {
                label.resize(label.size() - std::string(unit).size());
                break;
            }
        ImGui::TextUnformatted(label.c_str());
        const std::string unit = info->unit == "1" ? "" : " " + std::string(info->unit);
        ImGui::TableNextColumn();
        ImGui::Text("%.3g%s", view.metrics.*info->value, unit.c_str());
        if (!view.expert) continue;
        ImGui::TableNextColumn();
        ImGui::TextDisabled("%.3g%s", view.expert->metrics.*info->value, unit.c_str());
    }
    ImGui::EndTable();
}

// Vessels from before the patient, and the tips' ways through them.
void draw_way(const ResultView& view, float width, float height) {
    ImGui::TextUnformatted("Way of the tip");
    const ImVec2 at = ImGui::GetCursorScreenPos();
    ImDrawList* list = ImGui::GetWindowDrawList();
    const ImVec2 end(at.x + width, at.y + height);
    list->AddRectFilled(at, end, IM_COL32(28, 34, 40, 255));
    float x0 = 1e9F, x1 = -1e9F, z0 = 1e9F, z1 = -1e9F;
    for (const auto& line : view.vessels)
        for (const Vec3& p : line) {
            x0 = std::min(x0, static_cast<float>(p.x()));
            x1 = std::max(x1, static_cast<float>(p.x()));
            z0 = std::min(z0, static_cast<float>(p.z()));
            z1 = std::max(z1, static_cast<float>(p.z()));
        }
    if (x1 > x0 && z1 > z0) {
        const float scale = 0.92F * std::min(width / (x1 - x0), height / (z1 - z0));
        const auto place = [&](const Vec3& p) {
            return ImVec2(at.x + 0.5F * width + scale * (static_cast<float>(p.x()) - 0.5F * (x0 + x1)),
                          at.y + 0.5F * height - scale * (static_cast<float>(p.z()) - 0.5F * (z0 + z1)));
        };
        const auto draw = [&](const std::vector<Vec3>& points, ImU32 color, float thick) {
            std::vector<ImVec2> line;
            for (const Vec3& p : points) {
                const ImVec2 q = place(p);
                if (line.empty() || std::hypot(q.x - line.back().x, q.y - line.back().y) > 1.0F) line.push_back(q);
            }
            list->AddPolyline(line.data(), static_cast<int>(line.size()), color, 0, thick);
        };
        list->PushClipRect(at, end, true);
        for (const auto& vessel : view.vessels) draw(vessel, IM_COL32(96, 108, 118, 255), 1.5F);
        if (view.expert) draw(view.expert->course.tip, expert_color, 2.0F);
        draw(view.course.tip, own_color, 2.0F);
        list->PopClipRect();
    }
    ImGui::Dummy(ImVec2(width, height));
    ImGui::TextColored(ImGui::ColorConvertU32ToFloat4(own_color), "you");
    if (!view.expert) return;
    ImGui::SameLine();
    ImGui::TextColored(ImGui::ColorConvertU32ToFloat4(expert_color), "expert");
}

Wish draw_expert(const ResultView& view) {
    Wish wish = Wish::none;
    if (view.expert) {
        ImGui::TextDisabled("An expert autopilot %s here, score %.0f.",
                            view.expert->reached ? "arrives" : "does not arrive", view.expert->score);
    } else if (view.expert_wanted) {
        if (ImGui::Button("Compare with an expert")) wish = Wish::expert;
    }
    if (!view.expert && !view.expert_note.empty()) ImGui::TextDisabled("%s", view.expert_note.c_str());
    return wish;
}

// "2026-01-31-120005-name" -> "01-31 12:00"; any other name as it is.
std::string when(const std::string& name) {
    constexpr std::size_t date = 17;
    const std::string digits = name.substr(0, date);
    if (digits.size() < date || digits.find_first_not_of("0123456789-") != std::string::npos) return name;
    return digits.substr(5, 5) + " " + digits.substr(11, 2) + ":" + digits.substr(13, 2);
}

void draw_earlier(const ResultView& view) {
    if (view.earlier.empty()) {
        ImGui::TextDisabled("This is the first trial of this task here.");
        return;
    }
    if (!ImGui::BeginTable("earlier", 6, ImGuiTableFlags_RowBg | ImGuiTableFlags_SizingStretchProp)) return;
    for (const char* title : {"earlier", "help", "score", "time", "X-rays", "force"}) ImGui::TableSetupColumn(title);
    ImGui::TableHeadersRow();
    for (const ResultView::Earlier& trial : view.earlier) {
        ImGui::TableNextRow();
        ImGui::TableNextColumn();
        ImGui::TextUnformatted(when(trial.name).c_str());
        ImGui::TableNextColumn();
        ImGui::TextUnformatted(trial.difficulty.c_str());
        for (const double value : {trial.score, trial.play_time_s, trial.fluoroscopy_time_s, trial.force_bar_max}) {
            ImGui::TableNextColumn();
            ImGui::Text("%.3g", value);
        }
    }
    ImGui::EndTable();
}

}  // namespace

void draw_plot(const char* label, const std::vector<float>& values, const std::vector<float>& other, float top,
               float mark, float width, float height, const std::string& left, const std::string& right) {
    ImGui::TextUnformatted(label);
    const ImVec2 at = ImGui::GetCursorScreenPos();
    ImDrawList* list = ImGui::GetWindowDrawList();
    list->AddRectFilled(at, ImVec2(at.x + width, at.y + height), IM_COL32(28, 34, 40, 255));
    const auto y_of = [&](float v) { return at.y + height * (1.0F - std::clamp(v / top, 0.0F, 1.0F)); };
    if (mark > 0.0F && mark < top)
        list->AddLine(ImVec2(at.x, y_of(mark)), ImVec2(at.x + width, y_of(mark)), IM_COL32(213, 94, 0, 255), 1.5F);
    const std::size_t longest = std::max(values.size(), other.size());
    // The largest value of each pixel's samples, so that no peak is lost.
    const auto draw = [&](const std::vector<float>& of, ImU32 color) {
        const auto columns = static_cast<std::size_t>(std::max(2.0F, width));
        std::vector<ImVec2> line;
        for (std::size_t x = 0; x < columns; ++x) {
            const std::size_t from = x * longest / columns;
            const std::size_t to = std::min(std::max(from + 1, (x + 1) * longest / columns), of.size());
            if (from >= of.size()) break;
            float most = 0.0F;
            for (std::size_t i = from; i < to; ++i) most = std::max(most, of[i]);
            line.emplace_back(at.x + static_cast<float>(x), y_of(most));
        }
        list->AddPolyline(line.data(), static_cast<int>(line.size()), color, 0, 1.5F);
    };
    list->PushClipRect(at, ImVec2(at.x + width, at.y + height), true);
    draw(other, expert_color);
    draw(values, own_color);
    list->PopClipRect();
    ImGui::Dummy(ImVec2(width, height));
    ImGui::TextDisabled("%s", left.c_str());
    ImGui::SameLine(std::max(0.0F, width - ImGui::CalcTextSize(right.c_str()).x));
    ImGui::TextDisabled("%s", right.c_str());
}

Wish draw_result(const ResultView& view, const ScreenLayout& layout) {
    Wish wish = Wish::none;
    begin_menu("result", layout, 70.0F, 42.0F);
    ImGui::TextUnformatted(view.title.c_str());
    ImGui::TextUnformatted(view.outcome.c_str());
    if (view.score) {
        ImGui::SameLine();
        ImGui::Text("Score %.0f of 100", *view.score);
    }
    ImGui::Separator();
    const float height = ImGui::GetContentRegionAvail().y - 4.4F * layout.em;
    const float all = ImGui::GetContentRegionAvail().x;
    ImGui::BeginChild("figures", ImVec2(0.38F * all, height), false, ImGuiWindowFlags_NavFlattened);
    draw_metrics(view);
    if (const Wish other = draw_expert(view); other != Wish::none) wish = other;
    ImGui::EndChild();
    ImGui::SameLine(0.0F, layout.em);
    ImGui::BeginChild("course", ImVec2(0.37F * all, height), false, ImGuiWindowFlags_NavFlattened);
    const float width = ImGui::GetContentRegionAvail().x - layout.em;
    const std::vector<float> none;
    const std::vector<float>& other = view.expert ? view.expert->course.force_bar : none;
    float top = 1.2F;
    for (const auto* course : {&view.course.force_bar, &other})
        for (const float bar : *course) top = std::max(top, 1.1F * bar);
    draw_plot("Force bar over time (line: the limit)", view.course.force_bar, other, top, 1.0F, width, 9.0F * layout.em,
              "0:00", time_text(static_cast<double>(std::max(view.course.force_bar.size(), other.size())) * view.dt));
    ImGui::Spacing();
    draw_earlier(view);
    ImGui::EndChild();
    ImGui::SameLine(0.0F, layout.em);
    ImGui::BeginChild("way", ImVec2(0.0F, height), false, ImGuiWindowFlags_NavFlattened);
    draw_way(view, ImGui::GetContentRegionAvail().x, height - 3.2F * layout.em);
    ImGui::EndChild();
    if (!view.folder.empty()) ImGui::TextDisabled("kept in %s", view.folder.c_str());
    if (view.trial) {
        if (menu_button("Go on", 12.0F, true)) wish = Wish::questions;
    } else {
        if (menu_button("Again", 12.0F, true)) wish = Wish::again;
        ImGui::SameLine();
        if (menu_button("Next", 12.0F)) wish = Wish::to_start;
    }
    ImGui::SameLine();
    if (menu_button("Quit", 8.0F)) wish = Wish::quit;
    end_menu();
    return wish;
}

}  // namespace cathlab::play
