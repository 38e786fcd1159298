#include <imgui.h>

#include <algorithm>
#include <array>
#include <cstdio>

#include "hud/hud_data.h"
#include "play/screens.h"

namespace cathlab::play {
namespace {

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

void draw_metrics(const Metrics& metrics) {
    if (!ImGui::BeginTable("metrics", 2, ImGuiTableFlags_RowBg | ImGuiTableFlags_SizingStretchProp)) return;
    ImGui::TableSetupColumn("", 0, 0.65F);
    ImGui::TableSetupColumn("", 0, 0.35F);
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
        ImGui::TableNextColumn();
        const std::string unit = info->unit == "1" ? "" : " " + std::string(info->unit);
        ImGui::Text("%.3g%s", metrics.*info->value, unit.c_str());
    }
    ImGui::EndTable();
}

void draw_earlier(const ResultView& view) {
    if (view.earlier.empty()) {
        ImGui::TextDisabled("This is the first trial of this task here.");
        return;
    }
    if (!ImGui::BeginTable("earlier", 5, ImGuiTableFlags_RowBg | ImGuiTableFlags_SizingStretchProp)) return;
    for (const char* title : {"earlier trial", "score", "time s", "X-rays s", "force bar"})
        ImGui::TableSetupColumn(title);
    ImGui::TableHeadersRow();
    for (const ResultView::Earlier& trial : view.earlier) {
        ImGui::TableNextRow();
        ImGui::TableNextColumn();
        ImGui::TextUnformatted(trial.name.c_str());
        for (const double value : {trial.score, trial.play_time_s, trial.fluoroscopy_time_s, trial.force_bar_max}) {
            ImGui::TableNextColumn();
            ImGui::Text("%.3g", value);
        }
    }
    ImGui::EndTable();
}

}  // namespace

void draw_plot(const char* label, const std::vector<float>& values, float top, float mark, float width, float height,
               const std::string& left, const std::string& right) {
    ImGui::TextUnformatted(label);
    const ImVec2 at = ImGui::GetCursorScreenPos();
    ImDrawList* list = ImGui::GetWindowDrawList();
    list->AddRectFilled(at, ImVec2(at.x + width, at.y + height), IM_COL32(28, 34, 40, 255));
    const auto y_of = [&](float v) { return at.y + height * (1.0F - std::clamp(v / top, 0.0F, 1.0F)); };
    if (mark > 0.0F && mark < top)
        list->AddLine(ImVec2(at.x, y_of(mark)), ImVec2(at.x + width, y_of(mark)), IM_COL32(213, 94, 0, 255), 1.5F);
    // The largest value of each pixel's samples, so that no peak is lost.
    const auto columns = static_cast<std::size_t>(std::max(2.0F, width));
    std::vector<ImVec2> line;
    for (std::size_t x = 0; x < columns && !values.empty(); ++x) {
        const std::size_t from = x * values.size() / columns;
        const std::size_t to = std::max(from + 1, (x + 1) * values.size() / columns);
        float most = 0.0F;
        for (std::size_t i = from; i < std::min(to, values.size()); ++i) most = std::max(most, values[i]);
        line.emplace_back(at.x + static_cast<float>(x), y_of(most));
    }
    list->AddPolyline(line.data(), static_cast<int>(line.size()), IM_COL32(86, 180, 233, 255), 0, 1.5F);
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
    const float left = 0.42F * ImGui::GetContentRegionAvail().x;
    ImGui::BeginChild("figures", ImVec2(left, height), false, ImGuiWindowFlags_NavFlattened);
    draw_metrics(view.metrics);
    ImGui::EndChild();
    ImGui::SameLine(0.0F, layout.em);
    ImGui::BeginChild("course", ImVec2(0.0F, height), false, ImGuiWindowFlags_NavFlattened);
    const float width = ImGui::GetContentRegionAvail().x - layout.em;
    float top = 1.2F;
    for (const float bar : view.course.force_bar) top = std::max(top, 1.1F * bar);
    draw_plot("Force bar over time (line: the limit)", view.course.force_bar, top, 1.0F, width, 9.0F * layout.em,
              "0:00", time_text(static_cast<double>(view.course.force_bar.size()) * view.dt));
    ImGui::Spacing();
    draw_earlier(view);
    ImGui::EndChild();
    if (!view.folder.empty()) ImGui::TextDisabled("kept in %s", view.folder.c_str());
    if (menu_button("Again", 12.0F, true)) wish = Wish::again;
    ImGui::SameLine();
    if (menu_button("Next", 12.0F)) wish = Wish::to_start;
    ImGui::SameLine();
    if (menu_button("Quit", 8.0F)) wish = Wish::quit;
    end_menu();
    return wish;
}

}  // namespace cathlab::play
