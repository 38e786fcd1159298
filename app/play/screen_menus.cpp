#include <imgui.h>

#include <algorithm>
#include <cstdio>

#include "play/screens.h"

namespace cathlab::play {
namespace {

constexpr ImGuiWindowFlags plain =
    ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings;

// A box of names; true where another was chosen.  none: what "" is called, or null where one must be chosen.
bool choose(const char* label, std::string& value, const std::vector<std::string>& names, const char* none = nullptr) {
    bool changed = false;
    const std::string shown = value.empty() ? (none != nullptr ? none : "") : spoken(value);
    if (ImGui::BeginCombo(label, shown.c_str())) {
        if (none != nullptr && ImGui::Selectable(none, value.empty())) {
            value.clear();
            changed = true;
        }
        for (const std::string& name : names) {
            if (ImGui::Selectable(spoken(name).c_str(), name == value)) {
                value = name;
                changed = true;
            }
            if (name == value) ImGui::SetItemDefaultFocus();
        }
        ImGui::EndCombo();
    }
    return changed;
}

void draw_tasks(Setup& setup, const Choices& choices, const Setup& free_play) {
    ImGui::TextUnformatted("What to do");
    ImGui::Spacing();
    for (const TaskScene& task : choices.tasks)
        if (ImGui::RadioButton(task.title.c_str(), setup.task == task.id)) choose_task(task, setup);
    if (ImGui::RadioButton("Free play", setup.task.empty())) {
        const Difficulty difficulty = setup.difficulty;
        setup = free_play;
        setup.task.clear();
        setup.difficulty = difficulty;
    }
    ImGui::Spacing();
    ImGui::PushTextWrapPos(0.0F);
    const auto it = std::find_if(choices.tasks.begin(), choices.tasks.end(),
                                 [&](const TaskScene& task) { return task.id == setup.task; });
    ImGui::TextDisabled("%s", it != choices.tasks.end()
                                  ? it->task.instructions.c_str()
                                  : "Go where you like. There is no score; the metrics are kept.");
    ImGui::Spacing();
    for (const std::string& fault : choices.faults) ImGui::TextUnformatted(fault.c_str());
    ImGui::PopTextWrapPos();
}

void draw_choices(Setup& setup, const Choices& choices, const std::string& data_root) {
    ImGui::TextUnformatted("With what");
    ImGui::Spacing();
    ImGui::PushItemWidth(0.58F * ImGui::GetContentRegionAvail().x);
    choose("Entry", setup.entry, entries_of(setup.anatomy, data_root));
    choose("Guidewire", setup.wire, choices.wires, "none");
    choose("Catheter", setup.catheter, choices.catheters, "none");
    if (!choices.anatomies.empty() && !setup.anatomy.empty()) choose("Anatomy", setup.anatomy, choices.anatomies);
    ImGui::Checkbox("The heart beats", &setup.heart);
    if (setup.heart) {
        auto rate = static_cast<float>(setup.heart_rate_bpm);
        if (ImGui::SliderFloat("Beats a minute", &rate, 40.0F, 140.0F, "%.0f"))
            setup.heart_rate_bpm = static_cast<double>(rate);
    }
    if (ImGui::BeginCombo("Help", difficulty_name(setup.difficulty).c_str())) {
        for (const Difficulty d : {Difficulty::guided, Difficulty::standard, Difficulty::exam})
            if (ImGui::Selectable(difficulty_name(d).c_str(), d == setup.difficulty)) setup.difficulty = d;
        ImGui::EndCombo();
    }
    ImGui::PopItemWidth();
    ImGui::PushTextWrapPos(0.0F);
    ImGui::TextDisabled("%s", difficulty_text(setup.difficulty).c_str());
    ImGui::PopTextWrapPos();
    const std::string count = "Effects: " + std::to_string(setup.effects.size()) + " on###effects";
    if (ImGui::TreeNode(count.c_str())) {
        for (const std::string& name : choices.effects) {
            const auto it = std::find(setup.effects.begin(), setup.effects.end(), name);
            bool on = it != setup.effects.end();
            if (!ImGui::Checkbox(spoken(name).c_str(), &on)) continue;
            if (on)
                setup.effects.push_back(name);
            else
                setup.effects.erase(it);
        }
        ImGui::TreePop();
    }
}

}  // namespace

void begin_menu(const char* title, const ScreenLayout& layout, float width_em, float height_em) {
    const float w = std::min(layout.width - layout.em, width_em * layout.em);
    ImGui::SetNextWindowPos(ImVec2(0.5F * layout.width, 0.5F * layout.height), ImGuiCond_Always, ImVec2(0.5F, 0.5F));
    const float h = height_em > 0.0F ? std::min(layout.height - layout.em, height_em * layout.em) : 0.0F;
    ImGui::SetNextWindowSizeConstraints(ImVec2(w, h), ImVec2(w, h > 0.0F ? h : layout.height - layout.em));
    ImGui::Begin(title, nullptr, plain | (h > 0.0F ? 0 : ImGuiWindowFlags_AlwaysAutoResize));
}

void end_menu() {
    ImGui::End();
}

bool menu_button(const char* text, float width_em, bool first) {
    const bool pressed = ImGui::Button(text, ImVec2(width_em * ImGui::GetFontSize(), 2.2F * ImGui::GetFontSize()));
    if (first) ImGui::SetItemDefaultFocus();
    return pressed;
}

Wish draw_start(Setup& setup, const Choices& choices, const Setup& free_play, const std::string& data_root,
                const ScreenLayout& layout) {
    Wish wish = Wish::none;
    begin_menu("start", layout, 62.0F, 36.0F);
    ImGui::TextUnformatted("cathlab");
    ImGui::SameLine();
    ImGui::TextDisabled("a trainer for guidewire and catheter. Simulation, not for diagnosis.");
    ImGui::Separator();
    const float buttons = 4.2F * layout.em;
    const float height = ImGui::GetContentRegionAvail().y - buttons;
    const float half = 0.5F * ImGui::GetContentRegionAvail().x - 0.5F * layout.em;
    ImGui::BeginChild("tasks", ImVec2(half, height), false, ImGuiWindowFlags_NavFlattened);
    draw_tasks(setup, choices, free_play);
    ImGui::EndChild();
    ImGui::SameLine(0.0F, layout.em);
    ImGui::BeginChild("choices", ImVec2(0.0F, height), false, ImGuiWindowFlags_NavFlattened);
    draw_choices(setup, choices, data_root);
    ImGui::EndChild();
    ImGui::Separator();
    const bool able = !setup.wire.empty() || !setup.catheter.empty();
    if (menu_button(able ? "Start" : "Choose a device", 14.0F, true) && able) wish = Wish::start;
    ImGui::SameLine();
    if (menu_button("Settings", 10.0F)) wish = Wish::settings;
    ImGui::SameLine();
    if (menu_button("Controls", 10.0F)) wish = Wish::help;
    ImGui::SameLine();
    if (menu_button("Quit", 8.0F)) wish = Wish::quit;
    end_menu();
    return wish;
}

void draw_loading(double fraction, const std::string& what, const ScreenLayout& layout) {
    begin_menu("loading", layout, 32.0F);
    ImGui::TextUnformatted("Preparing the patient");
    ImGui::ProgressBar(static_cast<float>(fraction), ImVec2(-1.0F, 1.4F * layout.em));
    ImGui::TextDisabled("%s", what.empty() ? "a new anatomy takes a minute, a known one a second" : what.c_str());
    end_menu();
}

Wish draw_pause(const ScreenLayout& layout, Paused what) {
    Wish wish = Wish::none;
    const bool replay = what == Paused::replay, trial = what == Paused::trial;
    begin_menu("pause", layout, 20.0F);
    ImGui::TextUnformatted("Paused");
    ImGui::Separator();
    constexpr float width = 18.0F;
    if (menu_button("Go on", width, true)) wish = Wish::resume;
    if (what == Paused::session && menu_button("Begin again", width)) wish = Wish::again;
    if (menu_button(replay ? "End the replay" : trial ? "End the trial" : "End the session", width)) wish = Wish::end;
    if (menu_button("Settings", width)) wish = Wish::settings;
    if (menu_button("Controls", width)) wish = Wish::help;
    if (what == Paused::session && menu_button("To the start screen", width)) wish = Wish::to_start;
    if (menu_button("Quit", width)) wish = Wish::quit;
    if (trial) {
        ImGui::PushTextWrapPos(0.0F);
        ImGui::TextDisabled("A trial that is ended counts as it is; after Quit it does not count and comes again.");
        ImGui::PopTextWrapPos();
    }
    end_menu();
    return wish;
}

Wish draw_help(const Bindings& bindings, const ScreenLayout& layout) {
    Wish wish = Wish::none;
    begin_menu("help", layout, 74.0F, 44.0F);
    ImGui::TextUnformatted("Controls");
    ImGui::SameLine();
    ImGui::TextDisabled("let a stick or key go and the devices stand still");
    ImGui::Separator();
    ImGui::BeginChild("table", ImVec2(0.0F, ImGui::GetContentRegionAvail().y - 3.2F * layout.em), false,
                      ImGuiWindowFlags_NavFlattened);
    if (ImGui::BeginTable("bindings", 4, ImGuiTableFlags_RowBg | ImGuiTableFlags_SizingStretchProp)) {
        ImGui::TableSetupColumn("what", 0, 0.20F);
        ImGui::TableSetupColumn("gamepad", 0, 0.21F);
        ImGui::TableSetupColumn("keyboard and mouse", 0, 0.21F);
        ImGui::TableSetupColumn("", 0, 0.38F);
        ImGui::TableHeadersRow();
        for (const ControlInfo& info : control_table()) {
            ImGui::TableNextRow();
            const auto cell = [](const std::string& text, bool faint = false) {
                ImGui::TableNextColumn();
                ImGui::PushTextWrapPos(0.0F);
                if (faint)
                    ImGui::TextDisabled("%s", text.c_str());
                else
                    ImGui::TextUnformatted(text.c_str());
                ImGui::PopTextWrapPos();
            };
            cell(std::string(info.label));
            cell(bindings.labels(info.control, true));
            cell(bindings.labels(info.control, false));
            cell(std::string(info.doc), true);
        }
        ImGui::EndTable();
    }
    ImGui::EndChild();
    if (menu_button("Close", 14.0F, true)) wish = Wish::close;
    end_menu();
    return wish;
}

}  // namespace cathlab::play
