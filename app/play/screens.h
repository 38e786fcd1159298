// The screens, in ImGui calls alone: each shows plain data and says what was asked for.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "play/expert.h"
#include "play/input_state.h"
#include "play/setup.h"
#include "play/sim_thread.h"
#include "render/frame_renderer.h"
#include "study/questionnaire.h"

namespace cathlab::play {

/// Where things stand in the window, pixels.
struct ScreenLayout {
    float width = 1280, height = 720;
    FrameRect fluoroscopy, side;  ///< side: inner view or kept picture
    FrameRect panel;              ///< between it and the force bars
    float em = 16;                ///< height of the text
    float foot = 0;               ///< of the fluoroscopy: what the panels write there reaches up so far
};

/// What a menu's button asks for.
enum class Wish {
    none,
    start,
    resume,
    again,
    end,  ///< the session, with its result
    to_start,
    settings,
    help,
    quit,
    save,
    close,
    questions,  ///< after a study's trial
    skip,       ///< them
    expert      ///< flies one for comparison
};

/// One column of big buttons begins the window of a menu; its size follows its content.
void begin_menu(const char* title, const ScreenLayout& layout, float width_em, float height_em = 0.0F);
void end_menu();
/// A wide button; `first`: where keys and pad begin.
bool menu_button(const char* text, float width_em, bool first = false);

/// free_play: what is laid under it where no task is chosen.
Wish draw_start(Setup& setup, const Choices& choices, const Setup& free_play, const std::string& data_root,
                const ScreenLayout& layout);
void draw_loading(double fraction, const std::string& what, const ScreenLayout& layout);
/// What may be done in the pause depends on what is paused.
enum class Paused { session, replay, trial };
Wish draw_pause(const ScreenLayout& layout, Paused what);

/// Between two trials of a study.
struct StudyView {
    std::string participant, title, instructions;  ///< of the next trial; no title = all are done
    int done = 0, total = 0;
};
Wish draw_study(const StudyView& view, const ScreenLayout& layout);

/// One sheet of questions after another.
struct QuestionsView {
    Answers answers;
    std::size_t sheet = 0;
    bool changed = false;  ///< since it was last kept
};
Wish draw_questions(QuestionsView& view, const ScreenLayout& layout);

/// Buttons of the panel beside the picture that act on a session.
struct PlayWishes {
    std::function<void(Control)> press;
    std::function<void(Control, double)> hold;
    std::function<void(double primary_deg, double secondary_deg)> turn_to;
    std::function<void(int what)> acquire;                     ///< 0 fluoroscopy, 1 cine, 2 DSA
    std::function<void(int level)> set_level;                  ///< 0 low, 1 normal, 2 high
    std::function<void(double width, double height)> open_to;  ///< the collimator, shares of the field
    std::function<void(std::int64_t step)> seek;
    bool menu = false, hands = false;
};
struct PlayView {
    Status status;
    Difficulty difficulty = Difficulty::standard;
    std::string task;        ///< its instructions, "" = none
    std::string side_title;  ///< of the view beside the fluoroscopy
    bool hands_open = false, roadmap_allowed = true;
    bool recording = false, replay = false;
    double latency_ms = 0.0;
    std::vector<std::string> toasts;
    double replay_s = 0.0;
};
void draw_play(const PlayView& view, const ScreenLayout& layout, const Bindings& bindings, PlayWishes& wishes);

/// What the result screen shows.
struct ResultView {
    std::string title, folder;
    std::optional<double> score;
    std::string outcome;
    Metrics metrics;
    Course course;
    double dt = 0.02;
    struct Earlier {
        std::string name;
        double score = 0.0, play_time_s = 0.0, force_bar_max = 0.0, fluoroscopy_time_s = 0.0;
        std::string difficulty = {};
    };
    std::vector<Earlier> earlier;            ///< newest first
    bool trial = false;                      ///< of a study: there is no other go at it
    std::vector<std::vector<Vec3>> vessels;  ///< their middle, for the way
    std::optional<ExpertCourse> expert;
    std::string expert_note;     ///< while there is none: why, or how far it is
    bool expert_wanted = false;  ///< there is a task that an expert could do, and none is on it
};
Wish draw_result(const ResultView& view, const ScreenLayout& layout);

/// The table of bindings as the trainee reads it.
Wish draw_help(const Bindings& bindings, const ScreenLayout& layout);

/// The settings' panel; changes `settings` at once.
struct SettingsView {
    std::optional<Control> listening;  ///< waits for a place for this control
    bool negative = false;             ///< ... for its other way
    std::string note;
    int tab = -1;  ///< to be opened now; -1 = as it stands
};
Wish draw_settings(Settings& settings, SettingsView& view, InputState& input, const ScreenLayout& layout);

/// A short line plot of one value a sample, with a line at `mark` where that is in range; `other` fainter behind it, on
/// the same time.
void draw_plot(const char* label, const std::vector<float>& values, const std::vector<float>& other, float top,
               float mark, float width, float height, const std::string& left, const std::string& right);

}  // namespace cathlab::play
