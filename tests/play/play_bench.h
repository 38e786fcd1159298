// A trainer that a test drives turn by turn: a small anatomy, a short task, a window without a display.
#pragma once

#include <SDL.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <memory>
#include <string>

#include "play/play_app.h"
#include "play/tour.h"
#include "scene/temporary_folder.h"

namespace cathlab::play {

class PlayBench : public testing::Test {
protected:
    static constexpr double dt = 0.02;  // a turn is a step of the simulation

    void SetUp() override;
    void TearDown() override;

    /// Begins the program anew; the settings' file stays.
    void start(bool at_once = true, const std::string& task = "short");
    void frames(int count);
    /// Until there is another screen than this; false where that takes longer than so many turns.
    bool leave(Screen screen, int most);
    void key(SDL_Scancode code, bool down) { send_key(code, down); }
    void tap(SDL_Scancode code);
    Status status() { return app->simulation()->status(); }
    PlayOptions options();

    TemporaryFolder folder;
    AppContext context;
    std::string driver = "dummy";
    int width = 640, height = 360;
    std::unique_ptr<PlayApp> app;
};

/// A pad that is not there: SDL's virtual joystick.
class VirtualPad {
public:
    VirtualPad();
    ~VirtualPad();
    VirtualPad(const VirtualPad&) = delete;
    VirtualPad& operator=(const VirtualPad&) = delete;

    void axis(SDL_GameControllerAxis axis, double value);
    void button(SDL_GameControllerButton button, bool down);
    void unplug();
    Uint16 low = 0, high = 0;  ///< of the last rumble
    int rumbles = 0;

private:
    int index_ = -1;
    SDL_Joystick* joystick_ = nullptr;
};

}  // namespace cathlab::play
