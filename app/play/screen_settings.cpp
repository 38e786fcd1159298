#include <imgui.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <cmath>

#include "play/screens.h"

namespace cathlab::play {
namespace {

// "advance_mm_s" in mm/s -> "advance"
std::string label_of(const FieldSpec& field) {
    std::string label = spoken(field.key);
    for (const char* unit : {" mm s", " deg s", " ml s", " mm"})
        if (label.ends_with(unit)) return label.substr(0, label.size() - std::string(unit).size());
    return label;
}

// A widget for one key of the settings, whatever its kind.
void draw_field(const FieldSpec& field, void* object) {
    const FieldValue value = field.load(object);
    const std::string label = label_of(field);
    const std::string unit = field.unit == "1" || field.unit.empty() ? "" : " " + field.unit;
    const float width = 0.42F * ImGui::GetContentRegionAvail().x;
    ImGui::SetNextItemWidth(width);
    if (const auto* number = std::get_if<double>(&value)) {
        auto shown = static_cast<float>(*number);
        const float span = static_cast<float>(field.range.maximum - field.range.minimum);
        if (ImGui::SliderFloat(label.c_str(), &shown, static_cast<float>(field.range.minimum),
                               static_cast<float>(field.range.maximum),
                               ((span > 20.0F ? "%.0f" : "%.2f") + unit).c_str()))
            field.store(object, std::clamp(static_cast<double>(shown), field.range.minimum, field.range.maximum));
    } else if (const auto* integer = std::get_if<std::int64_t>(&value)) {
        int shown = static_cast<int>(*integer);
        if (ImGui::SliderInt(label.c_str(), &shown, static_cast<int>(field.range.minimum),
                             static_cast<int>(field.range.maximum), ("%d" + unit).c_str()))
            field.store(object, static_cast<std::int64_t>(shown));
    } else if (const auto* boolean = std::get_if<bool>(&value)) {
        bool shown = *boolean;
        if (ImGui::Checkbox(label.c_str(), &shown)) field.store(object, shown);
    } else if (const auto* text = std::get_if<std::string>(&value)) {
        if (field.choices.empty()) {
            std::string shown = *text;
            if (ImGui::InputText(label.c_str(), &shown)) field.store(object, shown);
        } else if (ImGui::BeginCombo(label.c_str(), text->c_str())) {
            for (const std::string& choice : field.choices)
                if (ImGui::Selectable(choice.c_str(), choice == *text)) field.store(object, choice);
            ImGui::EndCombo();
        }
    }
    ImGui::SameLine();
    ImGui::TextDisabled("%s", field.doc.c_str());
}

void draw_section(Settings& settings, const char* key) {
    for (const FieldSpec& section : settings_table().spec().fields) {
        if (section.key != key) continue;
        void* object = section.open(&settings);
        for (const FieldSpec& field : section.sub->fields) draw_field(field, object);
    }
}

// The curve of a stick, and where the sticks are on it.
void draw_curve(const Settings& settings, const InputState& input, const ScreenLayout& layout) {
    const float side = 9.0F * layout.em;
    const ImVec2 at = ImGui::GetCursorScreenPos();
    ImDrawList* list = ImGui::GetWindowDrawList();
    list->AddRectFilled(at, ImVec2(at.x + side, at.y + side), IM_COL32(28, 34, 40, 255));
    std::vector<ImVec2> line;
    for (int i = 0; i <= 60; ++i) {
        const double r = i / 60.0;
        line.emplace_back(at.x + side * static_cast<float>(r),
                          at.y + side * static_cast<float>(1.0 - shaped(settings.input.stick, r)));
    }
    list->AddPolyline(line.data(), static_cast<int>(line.size()), IM_COL32(86, 180, 233, 255), 0, 2.0F);
    const auto mark = [&](const StickPlace& stick, ImU32 color) {
        const double r = std::min(1.0, std::hypot(stick.x, stick.y));
        list->AddCircleFilled(ImVec2(at.x + side * static_cast<float>(r),
                                     at.y + side * static_cast<float>(1.0 - shaped(settings.input.stick, r))),
                              4.0F, color);
    };
    mark(input.left_stick(), IM_COL32(230, 159, 0, 255));
    mark(input.right_stick(), IM_COL32(0, 158, 115, 255));
    ImGui::Dummy(ImVec2(side, side));
    ImGui::SameLine();
    ImGui::TextDisabled("speed over the stick's place\norange: left stick\ngreen: right stick");
}

void draw_bindings(Settings& settings, SettingsView& view, InputState& input) {
    if (view.listening) {
        if (auto heard = input.heard()) {
            if (view.negative) heard->negative = !heard->negative;
            const auto taken = settings.bindings.bind(*view.listening, *heard);
            const auto label = [](Control c) {
                return std::string(control_table()[static_cast<std::size_t>(c)].label);
            };
            view.note = source_label(*heard) + " is now: " + label(*view.listening);
            if (taken) view.note += " (it was: " + label(*taken) + ")";
            view.listening.reset();
        } else if (!input.listening()) {
            view.listening.reset();
        }
    }
    ImGui::TextDisabled("%s", view.listening ? "press a key or button, or move a stick far; Escape gives up"
                              : view.note.empty()
                                  ? "a place: removes it;   +: adds one;   -: adds one for the other way"
                                  : view.note.c_str());
    if (ImGui::SmallButton("All as at first")) settings.bindings = default_bindings();
    if (!ImGui::BeginTable("bindings", 2, ImGuiTableFlags_RowBg | ImGuiTableFlags_SizingStretchProp)) return;
    ImGui::TableSetupColumn("", 0, 0.28F);
    ImGui::TableSetupColumn("", 0, 0.72F);
    for (const ControlInfo& info : control_table()) {
        ImGui::TableNextRow();
        ImGui::TableNextColumn();
        ImGui::TextUnformatted(info.label.data());
        ImGui::TableNextColumn();
        ImGui::PushID(static_cast<int>(info.control));
        std::vector<Source>& sources = settings.bindings.of(info.control);
        for (std::size_t i = 0; i < sources.size(); ++i) {
            ImGui::PushID(static_cast<int>(i));
            const bool remove = ImGui::SmallButton(source_label(sources[i]).c_str());
            ImGui::PopID();
            ImGui::SameLine();
            if (!remove) continue;
            sources.erase(sources.begin() + static_cast<std::ptrdiff_t>(i));
            break;
        }
        const auto add = [&](const char* text, bool negative) {
            const bool waits = view.listening == info.control && view.negative == negative;
            if (!ImGui::SmallButton(waits ? "..." : text)) return;
            view.listening = info.control;
            view.negative = negative;
            input.listen(true);
        };
        add("+", false);
        if (info.kind == ControlKind::axis) {
            ImGui::SameLine();
            add("-", true);
        }
        ImGui::PopID();
    }
    ImGui::EndTable();
}

}  // namespace

Wish draw_settings(Settings& settings, SettingsView& view, InputState& input, const ScreenLayout& layout) {
    Wish wish = Wish::none;
    begin_menu("settings", layout, 74.0F, 44.0F);
    ImGui::BeginChild("tabs", ImVec2(0.0F, ImGui::GetContentRegionAvail().y - 3.2F * layout.em), false,
                      ImGuiWindowFlags_NavFlattened);
    if (ImGui::BeginTabBar("settings")) {
        int index = 0;
        const auto tab = [&](const char* name) {
            const bool select = view.tab == index++;
            return ImGui::BeginTabItem(name, nullptr, select ? ImGuiTabItemFlags_SetSelected : 0);
        };
        if (tab("Hands")) {
            draw_section(settings, "input");
            draw_curve(settings, input, layout);
            ImGui::EndTabItem();
        }
        if (tab("Keys and buttons")) {
            draw_bindings(settings, view, input);
            ImGui::EndTabItem();
        }
        if (tab("View and sound")) {
            draw_section(settings, "view");
            ImGui::Separator();
            draw_section(settings, "sound");
            ImGui::EndTabItem();
        }
        if (tab("Recording")) {
            draw_section(settings, "run");
            ImGui::EndTabItem();
        }
        view.tab = -1;
        ImGui::EndTabBar();
    }
    ImGui::EndChild();
    if (menu_button("Save and close", 14.0F, true)) wish = Wish::save;
    ImGui::SameLine();
    if (menu_button("Close", 10.0F)) wish = Wish::close;
    end_menu();
    return wish;
}

}  // namespace cathlab::play
