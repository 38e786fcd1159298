// A machine without a loudspeaker.
#include <algorithm>
#include <cstdlib>

#include "play/play_bench.h"
#include "play/tones.h"

namespace cathlab::play {
namespace {

/// SDL finds no sound device while this lives.
struct NoSound {
    NoSound() { setenv("SDL_AUDIODRIVER", "no-such-driver", 1); }
    ~NoSound() { unsetenv("SDL_AUDIODRIVER"); }
};

TEST(Tones, WithoutADeviceItSaysWhyAndIsSilent) {
    const NoSound none;
    Tones tones;
    EXPECT_EQ(tones.fault().find("no sound: "), 0U) << tones.fault();
    EXPECT_GT(tones.fault().size(), 15U);
    tones.play({true, 1.2}, {});
}

class Silent : public PlayBench {};

TEST_F(Silent, WithoutASoundDeviceTheTrainerSaysSoAndGoesOn) {
    const NoSound none;
    SDL_SetHint(SDL_HINT_VIDEODRIVER, "dummy");
    PlayOptions wanted = options();
    wanted.silent = false;
    wanted.task = "short";
    wanted.at_once = true;
    app = std::make_unique<PlayApp>(wanted, context);
    app->settings().run.folder = folder.path("runs");
    const auto& said = app->said();
    EXPECT_TRUE(std::any_of(said.begin(), said.end(),
                            [](const std::string& text) { return text.find("no sound") != std::string::npos; }));
    frames(5);
    key(SDL_SCANCODE_W, true);
    frames(10);
    EXPECT_GT(status().channels.wire_insertion_mm, 51.0);
}

}  // namespace
}  // namespace cathlab::play
