// The trainer: screens, window, hands, simulation, pictures and sound, one turn after another.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "context.h"
#include "hud/hud.h"
#include "hud/ui_context.h"
#include "play/clip.h"
#include "play/input_state.h"
#include "play/loader.h"
#include "play/pads.h"
#include "play/painter.h"
#include "play/screens.h"
#include "play/settings.h"
#include "play/study_desk.h"
#include "play/tones.h"
#include "play/ui_feed.h"
#include "play/window.h"

namespace cathlab::play {

struct PlayOptions {
    std::string scene;  ///< a path: played at once where it sets a task, or for free
    std::vector<std::string> overlays;
    std::string task;      ///< of scenes/tasks, instead of the scene; "" = none
    bool at_once = false;  ///< without the start screen
    std::string out;       ///< the first session's run folder, "" = a new one in the user's data folder
    std::string replay;    ///< a run folder to be shown, "" = none
    std::string study;     ///< the folder of a study whose trials are done, "" = none
    std::string participant;
    std::optional<Difficulty> difficulty;
    WindowOptions window;
    std::string settings;  ///< the file, "" = nowhere
    bool record = true;    ///< false: whatever the settings say
    bool threaded = true;  ///< false: everything happens within frame(), for tests
    bool silent = false;   ///< no sound device is opened
};

enum class Screen { start, loading, play, result, study, questions };
/// What stands beside the fluoroscopy.
enum class Side { inner, displacement, force, kept };

enum class Panel { none, pause, settings, help };

class PlayApp {
public:
    /// Throws UserError where there is no window to be had, or the scene cannot be read.
    PlayApp(PlayOptions options, const AppContext& context);
    ~PlayApp();
    PlayApp(const PlayApp&) = delete;
    PlayApp& operator=(const PlayApp&) = delete;

    /// One turn that stands for dt seconds: events, time, pictures, window.  False = the end.
    bool frame(double dt);
    /// A turn in real time, and what is left of a sixtieth of a second, or until there is a new picture.
    bool turn();
    /// Turns until the end.
    void run();

    /// What the window shows, as a picture.
    Image8 picture();
    /// The same without menus, toasts and buttons: what a film has.
    Image8 picture_without_screens();
    /// The panels as they were drawn last.
    const HudData& panels() const { return shown_panels_; }
    float hud_scale() const { return hud_scale_; }

    Screen screen() const { return screen_; }
    Side side() const { return side_; }
    Panel panel() const { return panels_.empty() ? Panel::none : panels_.back(); }
    void open(Panel panel);
    /// Closes the panel on top; without any, time goes on.
    void go_on();
    /// Of the settings: 0 hands, 1 keys, 2 view and sound, 3 recording.
    void select_tab(int tab) { settings_view_.tab = tab; }
    /// The session ends here, with its result.
    void end_trial() { follow(Wish::end); }
    /// Of a result: flies an expert in the same scene where none has been flown.
    void compare_with_expert() { follow(Wish::expert); }
    void open_hands(bool yes) { hands_open_ = yes; }
    Window& window() { return window_; }
    Settings& settings() { return settings_; }
    Setup& setup() { return setup_; }
    SimThread* simulation() { return sim_.get(); }
    Painter* painter() { return painter_.get(); }
    const ScreenLayout& layout() const { return layout_; }
    const std::vector<std::string>& said() const { return said_; }  ///< every toast so far
    const ResultView& result() const { return result_; }
    QuestionsView& questions() { return questions_; }
    std::string run_folder() const { return loader_.folder(); }
    /// Time from a hand's command to the window that shows it in a quick view, s; the newest, 0 = none yet.
    double latency_s() const { return latency_s_; }
    const Durations& latencies() const { return latencies_; }
    /// From here on they are counted anew.
    void forget_latencies() { latencies_ = {}; }
    void set_side(Side side);
    /// What a turn took, without its rest.
    const Durations& turn_cost() const { return turn_cost_; }

private:
    struct Toast {
        std::string text;
        double until_s = 0.0;
    };

    void begin_load(const std::string& folder);
    void begin_session(std::unique_ptr<Simulation> simulation);
    void end_session(bool with_result);
    void make_result(Simulation& simulation, bool reached);
    void keep_trial(bool recorded);
    void keep_answers();
    void to_study();
    void look_for_expert();
    std::string experts_home() const;
    void poll();
    void feed(const SDL_Event& event);
    void hands();
    void act(Control control);
    void act_on_time(Control control);
    void follow(Wish wish);
    void lay_out();
    void make_fonts();
    void take_pictures();
    void draw_screens(double dt);
    void compose();
    void draw_window();
    void note_latency();
    void note_aids();
    void rest(Clock::time_point begin);
    void next_side();
    void keep_picture();
    void say(const std::string& text, double shown_s = 5.0);
    void screenshot();
    void save_clip();
    /// A name in the session's folder, or the user's data folder, that nothing has yet.
    std::string new_file(const std::string& stem, const std::string& ending) const;
    void seek(std::int64_t step);
    bool steering() const { return screen_ == Screen::play && panels_.empty(); }
    bool views_allowed() const { return asked_.difficulty != Difficulty::exam && inner_allowed_; }
    bool roadmap_allowed() const { return asked_.difficulty != Difficulty::exam; }
    Paused paused_what() const;
    StudyView study_view() const;

    PlayOptions options_;
    const AppContext& context_;
    std::string settings_fault_;
    Settings settings_;
    Window window_;
    Pads pads_;
    std::optional<Tones> tones_;
    Loader loader_;
    std::optional<StudyDesk> desk_;
    TaskScene study_task_;  // of the next trial
    Expert expert_;
    SceneSpec flown_scene_;  // of the result that is shown
    std::shared_ptr<const SceneModels> flown_models_;
    bool flying_ = false;
    Choices choices_;
    Setup free_play_;
    Setup setup_, asked_;  // asked_: of the session that goes on

    std::unique_ptr<UiContext> ui_;
    std::unique_ptr<Hud> hud_;
    float em_ = 0.0F, hud_scale_ = 0.0F;
    UiFeed ui_feed_;
    InputState input_;
    Controls evaluated_, controls_;
    std::uint64_t stamp_ = 0;
    std::vector<std::pair<std::uint64_t, Clock::time_point>> stamps_;  // commands whose picture has not come
    double latency_s_ = 0.0;
    Durations latencies_, turn_cost_;
    std::uint64_t drawn_stamp_ = 0;  // of the newest picture of a quick view

    Screen screen_ = Screen::start;
    std::vector<Panel> panels_;
    bool quit_ = false, fullscreen_ = false, hands_open_ = false, was_paused_ = false;
    Side side_ = Side::inner;
    /// For how long each view stood in the window while the session went on, simulated s; by Side.
    std::array<double, 4> looked_s_{};
    double looked_until_s_ = 0.0;
    SettingsView settings_view_;
    ResultView result_;
    QuestionsView questions_;
    bool inner_allowed_ = true;  // by the task
    double now_s_ = 0.0;
    std::optional<Clock::time_point> turned_;
    std::optional<Clock::time_point> moved_at_;  // the first thing that a hand did since the last command
    std::vector<Toast> toasts_;
    std::vector<std::string> said_;

    std::unique_ptr<SimThread> sim_;
    std::unique_ptr<Painter> painter_;
    Status status_;
    ClipKeeper clip_;
    std::int64_t seek_to_ = -1;  ///< of a replay that is being begun again
    Image8 fluoroscopy_, inner_, outer_, kept_;
    std::uint64_t fluoroscopy_revision_ = 0, inner_revision_ = 0, outer_revision_ = 0, kept_revision_ = 0;
    ScreenLayout layout_;
    HudDrawList hud_list_, ui_list_;
    HudData shown_panels_;
    std::vector<WindowPicture> pictures_;
    std::vector<const HudDrawList*> lists_;
    bool shot_wanted_ = false;
};

}  // namespace cathlab::play
