#include "play/tour.h"

#include <SDL.h>
#include <unistd.h>

#include <cstdio>
#include <filesystem>

#include "core/errors.h"
#include "study/protocol.h"
#include "study/questionnaire.h"

namespace cathlab::play {
namespace {

constexpr double dt = 1.0 / 50.0;

class Tour {
public:
    Tour(PlayApp& app, std::string folder) : app_(app), folder_(std::move(folder)) {}
    void frames(int count) {
        for (int i = 0; i < count; ++i)
            if (!app_.frame(dt)) throw UserError("the tour was stopped");
    }
    void tap(SDL_Scancode key) {
        send_key(key, true);
        frames(1);
        send_key(key, false);
        frames(2);
    }
    void keep(const std::string& name) {
        frames(3);
        write_png(folder_ + "/" + name + ".png", app_.picture());
        std::printf("%s/%s.png\n", folder_.c_str(), name.c_str());
    }

private:
    PlayApp& app_;
    std::string folder_;
};

}  // namespace

void send_key(SDL_Scancode key, bool down) {
    SDL_Event event{};
    event.type = down ? SDL_KEYDOWN : SDL_KEYUP;
    event.key.state = down ? SDL_PRESSED : SDL_RELEASED;
    event.key.keysym.scancode = key;
    event.key.keysym.sym = SDL_GetKeyFromScancode(key);
    SDL_PushEvent(&event);
}

namespace {

void tour_of_play(const PlayOptions& options, const AppContext& context, const std::string& folder) {
    PlayApp app(options, context);
    Tour tour(app, folder);
    tour.keep("start");
    tour.tap(SDL_SCANCODE_RETURN);
    while (app.screen() == Screen::loading) tour.frames(1);
    send_key(SDL_SCANCODE_SPACE, true);
    send_key(SDL_SCANCODE_W, true);
    tour.frames(100);
    tour.keep("play");
    tour.tap(SDL_SCANCODE_R);
    tour.keep("kept");
    tour.tap(SDL_SCANCODE_V);
    tour.tap(SDL_SCANCODE_V);
    tour.keep("outside");
    tour.tap(SDL_SCANCODE_V);
    app.open_hands(true);
    tour.keep("mouse");
    app.open_hands(false);
    tour.tap(SDL_SCANCODE_ESCAPE);
    tour.keep("pause");
    app.open(Panel::help);
    tour.keep("controls");
    app.go_on();
    app.open(Panel::settings);
    const char* tabs[] = {"hands", "keys", "view", "recording"};
    for (int i = 0; i < 4; ++i) {
        app.select_tab(i);
        tour.keep(std::string("settings-") + tabs[i]);
    }
    app.go_on();
    app.go_on();
    send_key(SDL_SCANCODE_SPACE, false);
    send_key(SDL_SCANCODE_SPACE, true);
    send_key(SDL_SCANCODE_W, false);
    send_key(SDL_SCANCODE_W, true);
    // On to the goal; there the hand lets go.
    for (int i = 0; i < 1500 && app.screen() == Screen::play; ++i) {
        tour.frames(1);
        if (app.simulation() != nullptr && app.simulation()->status().goal.inside) send_key(SDL_SCANCODE_W, false);
    }
    app.compare_with_expert();
    tour.keep("result");
}

// A trial of a study that is there for the pictures alone.
void tour_of_a_study(PlayOptions options, const AppContext& context, const std::string& folder) {
    namespace fs = std::filesystem;
    const fs::path study = fs::temp_directory_path() / ("cathlab-tour-" + std::to_string(::getpid()));
    Protocol protocol;
    protocol.name = "tour";
    protocol.groups = {"novice"};
    protocol.tasks = {"first-steps", "a"};
    write_study(study.string(), protocol);
    add_participant(study.string(), protocol, {"P01", "novice", false});
    options.study = study.string();
    options.participant = "P01";
    {
        PlayApp app(options, context);
        Tour tour(app, folder);
        tour.keep("study");
        tour.tap(SDL_SCANCODE_RETURN);
        while (app.screen() == Screen::loading || app.screen() == Screen::study) tour.frames(1);
        tour.frames(20);
        tour.tap(SDL_SCANCODE_ESCAPE);
        tour.keep("trial-pause");
        app.end_trial();
        tour.frames(2);
        tour.tap(SDL_SCANCODE_RETURN);
        for (const QuestionSheet& sheet : question_sheets()) {
            auto& answers = app.questions().answers.sheets[app.questions().sheet];
            for (std::size_t q = 0; q + 2 < answers.size(); ++q)
                answers[q] = sheet.least + sheet.step * static_cast<int>((3 + q) % 5);
            tour.keep("questions-" + std::string(sheet.id));
            if (&sheet != &question_sheets().back()) ++app.questions().sheet;
        }
    }
    std::error_code error;
    fs::remove_all(study, error);
}

}  // namespace

void tour(PlayOptions options, const AppContext& context, const std::string& folder) {
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error) throw UserError("cannot make the folder '" + folder + "': " + error.message());
    SDL_SetHint(SDL_HINT_VIDEODRIVER, "dummy");
    options.window.plain = true;
    options.threaded = false;
    options.silent = true;
    options.record = false;
    tour_of_play(options, context, folder);
    tour_of_a_study(options, context, folder);
}

}  // namespace cathlab::play
