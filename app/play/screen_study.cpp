#include <imgui.h>

#include <algorithm>
#include <string>

#include "play/screens.h"

namespace cathlab::play {
namespace {

constexpr int few = 7;  // up to so many answers stand beside the question, more below it

// One row of round buttons from the least to the most answer.
bool draw_scale(const QuestionSheet& sheet, std::optional<int>& answer, float pitch, bool first) {
    bool changed = false;
    const float begin = ImGui::GetCursorPosX();
    for (int value = sheet.least; value <= sheet.most; value += sheet.step) {
        if (value > sheet.least) ImGui::SameLine();
        const int place = (value - sheet.least) / sheet.step;
        ImGui::SetCursorPosX(begin + pitch * static_cast<float>(place));
        ImGui::PushID(value);
        if (ImGui::RadioButton("##answer", answer == value)) {
            answer = value;
            changed = true;
        }
        if (first && value == sheet.least) ImGui::SetItemDefaultFocus();
        ImGui::PopID();
    }
    return changed;
}

void draw_few(const QuestionSheet& sheet, QuestionsView& view, const ScreenLayout& layout) {
    const float pitch = 3.0F * layout.em;
    const int count = (sheet.most - sheet.least) / sheet.step + 1;
    if (!ImGui::BeginTable("questions", 2, ImGuiTableFlags_RowBg)) return;
    ImGui::TableSetupColumn("", ImGuiTableColumnFlags_WidthStretch);
    ImGui::TableSetupColumn("", ImGuiTableColumnFlags_WidthFixed, pitch * static_cast<float>(count));
    ImGui::TableNextRow();
    ImGui::TableNextColumn();
    ImGui::TableNextColumn();
    ImGui::PushTextWrapPos(ImGui::GetCursorPosX() + 1.9F * pitch);
    const ImVec2 at = ImGui::GetCursorPos();
    ImGui::TextDisabled("%s", sheet.questions.front().low.data());
    ImGui::PopTextWrapPos();
    ImGui::SameLine();
    ImGui::SetCursorPos(ImVec2(at.x + pitch * static_cast<float>(count - 2) + 0.2F * pitch, at.y));
    ImGui::PushTextWrapPos(ImGui::GetCursorPosX() + 1.8F * pitch);
    ImGui::TextDisabled("%s", sheet.questions.front().high.data());
    ImGui::PopTextWrapPos();
    for (std::size_t q = 0; q < sheet.questions.size(); ++q) {
        ImGui::PushID(static_cast<int>(q));
        ImGui::TableNextRow();
        ImGui::TableNextColumn();
        ImGui::AlignTextToFramePadding();
        ImGui::PushTextWrapPos(0.0F);
        ImGui::TextUnformatted(sheet.questions[q].text.data());
        ImGui::PopTextWrapPos();
        ImGui::TableNextColumn();
        if (draw_scale(sheet, view.answers.sheets[view.sheet][q], pitch, q == 0)) view.changed = true;
        ImGui::PopID();
    }
    ImGui::EndTable();
}

void draw_many(const QuestionSheet& sheet, QuestionsView& view, const ScreenLayout& layout) {
    const int count = (sheet.most - sheet.least) / sheet.step + 1;
    const float pitch =
        std::min(2.2F * layout.em, (ImGui::GetContentRegionAvail().x - layout.em) / static_cast<float>(count));
    for (std::size_t q = 0; q < sheet.questions.size(); ++q) {
        const Question& question = sheet.questions[q];
        ImGui::PushID(static_cast<int>(q));
        ImGui::PushTextWrapPos(0.0F);
        ImGui::TextUnformatted(question.text.data());
        ImGui::PopTextWrapPos();
        if (draw_scale(sheet, view.answers.sheets[view.sheet][q], pitch, q == 0)) view.changed = true;
        ImGui::TextDisabled("%s", question.low.data());
        ImGui::SameLine(pitch * static_cast<float>(count) - ImGui::CalcTextSize(question.high.data()).x);
        ImGui::TextDisabled("%s", question.high.data());
        ImGui::Spacing();
        ImGui::PopID();
    }
}

}  // namespace

Wish draw_study(const StudyView& view, const ScreenLayout& layout) {
    Wish wish = Wish::none;
    begin_menu("study", layout, 44.0F);
    ImGui::Text("Participant %s", view.participant.c_str());
    ImGui::SameLine();
    ImGui::TextDisabled("%d of %d trials are done", view.done, view.total);
    ImGui::Separator();
    ImGui::PushTextWrapPos(0.0F);
    if (view.title.empty()) {
        ImGui::TextUnformatted("All trials are done. Thank you for taking part.");
    } else {
        ImGui::TextUnformatted(view.title.c_str());
        ImGui::TextDisabled("%s", view.instructions.c_str());
    }
    ImGui::PopTextWrapPos();
    ImGui::Spacing();
    if (!view.title.empty()) {
        if (menu_button("Start the trial", 14.0F, true)) wish = Wish::start;
        ImGui::SameLine();
        if (menu_button("Settings", 8.0F)) wish = Wish::settings;
        ImGui::SameLine();
        if (menu_button("Controls", 8.0F)) wish = Wish::help;
        ImGui::SameLine();
    }
    if (menu_button("Quit", 8.0F, view.title.empty())) wish = Wish::quit;
    end_menu();
    return wish;
}

Wish draw_questions(QuestionsView& view, const ScreenLayout& layout) {
    Wish wish = Wish::none;
    const QuestionSheet& sheet = question_sheets()[view.sheet];
    const std::string name = "questions " + std::string(sheet.id);  // a sheet of its own begins at its own top
    begin_menu(name.c_str(), layout, 66.0F, 44.0F);
    ImGui::TextUnformatted(sheet.title.data());
    ImGui::SameLine();
    ImGui::TextDisabled("sheet %zu of %zu; what is left open stays open", view.sheet + 1, question_sheets().size());
    ImGui::Separator();
    ImGui::BeginChild("sheet", ImVec2(0.0F, ImGui::GetContentRegionAvail().y - 3.0F * layout.em), false,
                      ImGuiWindowFlags_NavFlattened);
    if ((sheet.most - sheet.least) / sheet.step < few)
        draw_few(sheet, view, layout);
    else
        draw_many(sheet, view, layout);
    ImGui::EndChild();
    const bool last = view.sheet + 1 == question_sheets().size();
    if (menu_button(last ? "Done" : "Next sheet", 12.0F)) {
        if (last)
            wish = Wish::close;
        else
            ++view.sheet;
    }
    if (view.sheet > 0 && !(last && wish == Wish::close)) {
        ImGui::SameLine();
        if (menu_button("Back", 8.0F)) --view.sheet;
    }
    ImGui::SameLine();
    if (menu_button("Skip the questions", 14.0F)) wish = Wish::skip;
    end_menu();
    return wish;
}

}  // namespace cathlab::play
