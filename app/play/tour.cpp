#include "play/tour.h"

#include <SDL.h>

#include <cstdio>
#include <filesystem>

#include "core/errors.h"

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

void tour(PlayOptions options, const AppContext& context, const std::string& folder) {
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error) throw UserError("cannot make the folder '" + folder + "': " + error.message());
    SDL_SetHint(SDL_HINT_VIDEODRIVER, "dummy");
    options.window.plain = true;
    options.threaded = false;
    options.silent = true;
    options.record = false;
    options.settings.clear();
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
    tour.keep("result");
}

}  // namespace cathlab::play
