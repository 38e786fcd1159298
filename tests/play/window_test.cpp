// What the window shows, and what becomes of it when it is pulled about.
#include <algorithm>
#include <atomic>
#include <cmath>
#include <optional>

#include "app/program.h"
#include "hud/hud.h"
#include "play/play_bench.h"
#include "play/xvfb.h"

namespace cathlab::play {
namespace {

// Every fluoroscopy and inner view that the trainer drew, drawn once more by the film's renderer as one picture, and
// that compared with the window's pixels.
void expect_window_is_the_film(PlayApp& app, const Image8& window, const FrameDescription& described) {
    FrameDescription frame = described;
    FrameRenderer renderer(make_gl_target());
    Image8 wanted;
    const FrameRect& place = app.layout().fluoroscopy;
    frame.width = place.width;
    frame.height = place.height;
    renderer.render(frame, wanted);
    int worst = 0;
    std::size_t off = 0;
    for (int y = 0; y < place.height; ++y)
        for (int x = 0; x < place.width; ++x)
            for (std::size_t k = 0; k < 3; ++k) {
                const int d = std::abs(static_cast<int>(wanted.rgb[wanted.offset(x, y) + k]) -
                                       static_cast<int>(window.rgb[window.offset(place.x + x, place.y + y) + k]));
                worst = std::max(worst, d);
                off += d > 3 ? 1U : 0U;
            }
    EXPECT_EQ(off, 0U) << "largest difference " << worst;
}

class TrainerWindow : public PlayBench {
protected:
    std::optional<Xvfb> display;

    void TearDown() override {
        PlayBench::TearDown();  // the window goes before its display
        display.reset();
    }
    // The first exposed picture: no filter's memory before it.
    void compare() {
        start(true, "");
        app->settings().view.largest_picture = 2048;
        std::optional<FrameDescription> described;
        app->painter()->set_observer([&](View view, const FrameDescription& frame, const Image8&) {
            if (view == View::fluoroscopy && !described) described = frame;
        });
        key(SDL_SCANCODE_SPACE, true);
        for (int i = 0; i < 20 && !described; ++i) frames(1);
        ASSERT_TRUE(described);
        // The panels of that moment, over it, as a film has them; the toasts belong to the window alone.
        Hud hud(app->hud_scale());
        HudLayout layout;
        layout.width = app->layout().width;
        layout.height = app->layout().height;
        layout.split = static_cast<float>(app->layout().fluoroscopy.width);
        HudDrawList list;
        hud.draw(app->panels(), layout, list);
        // The same panels on a picture of the fluoroscopy's size: nothing of them left of it or above.
        list.width = static_cast<float>(app->layout().fluoroscopy.width);
        list.height = static_cast<float>(app->layout().fluoroscopy.height);
        for (DrawVertex& v : list.vertices) v.y -= static_cast<float>(app->layout().fluoroscopy.y);
        for (DrawCommand& c : list.commands) {
            c.y0 -= static_cast<float>(app->layout().fluoroscopy.y);
            c.y1 -= static_cast<float>(app->layout().fluoroscopy.y);
        }
        described->overlay = list;
        expect_window_is_the_film(*app, app->picture_without_screens(), *described);
    }
};

TEST_F(TrainerWindow, ShowsTheOffScreenFrameOfTheSameState) {
    compare();
}

TEST_F(TrainerWindow, ShowsTheOffScreenFrameUnderXvfbWithOpenGl) {
    display.emplace(1280, 800);
    if (!display->started()) GTEST_SKIP() << "the program Xvfb is missing (Debian package xvfb)";
    driver = "x11";
    compare();
    EXPECT_EQ(app->window().note(), "");
    EXPECT_NE(app->window().description().find("sdl"), std::string::npos);
}

TEST_F(TrainerWindow, CanBeTinyHugeAndMinimised) {
    display.emplace(1280, 800);
    if (!display->started()) GTEST_SKIP() << "the program Xvfb is missing (Debian package xvfb)";
    driver = "x11";
    start(true, "");
    key(SDL_SCANCODE_SPACE, true);
    const std::pair<int, int> sizes[] = {{64, 64}, {100, 700}, {700, 100}, {2560, 1440}, {3840, 2160}, {640, 360}};
    for (const auto& [w, h] : sizes) {
        app->window().resize(w, h);
        frames(4);
        EXPECT_EQ(app->window().width(), w);
        EXPECT_EQ(app->window().height(), h);
        const Image8 picture = app->picture();
        EXPECT_EQ(picture.width, w);
        const auto steps = status().steps;
        frames(2);
        EXPECT_EQ(status().steps, steps + 2);
    }
    SDL_Event event{};
    event.type = SDL_WINDOWEVENT;
    event.window.event = SDL_WINDOWEVENT_MINIMIZED;
    SDL_PushEvent(&event);
    const auto steps = status().steps;
    frames(5);
    EXPECT_EQ(status().steps, steps + 5);
}

TEST_F(TrainerWindow, WithoutOpenGlInTheWindowItIsDrawnOffScreenAndSaysSo) {
    SDL_SetHint(SDL_HINT_VIDEODRIVER, "dummy");
    PlayOptions wanted = options();
    wanted.window.plain = false;  // it asks for OpenGL, which SDL's dummy display has not
    wanted.at_once = true;
    app = std::make_unique<PlayApp>(wanted, context);
    frames(3);
    EXPECT_NE(app->window().note().find("off-screen"), std::string::npos) << app->window().note();
    EXPECT_TRUE(std::any_of(app->said().begin(), app->said().end(),
                            [](const std::string& text) { return text.find("no OpenGL") != std::string::npos; }));
    EXPECT_TRUE(app->screen() == Screen::play);
}

TEST_F(TrainerWindow, ASlowFluoroscopyKeepsTheQuickViewsAndTheHandNotWaiting) {
    SDL_SetHint(SDL_HINT_VIDEODRIVER, "dummy");
    PlayOptions wanted = options();
    wanted.threaded = true;
    wanted.at_once = true;
    wanted.record = false;
    app = std::make_unique<PlayApp>(wanted, context);
    app->settings().view.largest_picture = 2048;
    app->window().resize(3840, 2160);  // a fluoroscopy takes long
    while (app->screen() == Screen::loading) app->turn();
    key(SDL_SCANCODE_SPACE, true);
    std::atomic<int> quick = 0, between = 0, slow = 0;
    app->painter()->set_observer([&](View view, const FrameDescription&, const Image8&) {
        if (view == View::fluoroscopy && ++slow <= 2) between = quick.exchange(0);
        if (view != View::fluoroscopy) ++quick;
    });
    for (int i = 0; i < 600 && slow < 2; ++i) app->turn();
    ASSERT_GE(slow, 2);
    const Painter& painter = *app->painter();
    const double pictures = painter.cost(View::fluoroscopy).quantile(0.5) / painter.cost(View::inner).quantile(0.95);
    EXPECT_GE(between, std::min(2.0, 0.2 * pictures)) << "pictures of the view from the tip during one fluoroscopy";
    app.reset();
}

TEST_F(TrainerWindow, EveryScreenIsDrawnAtEverySizeOfText) {
    start(false);
    for (const double scale : {0.75, 1.0, 2.5}) {
        app->settings().view.hud_scale = scale;
        frames(3);
        for (const Panel panel : {Panel::settings, Panel::help}) {
            app->open(panel);
            frames(3);
            app->go_on();
        }
    }
    EXPECT_TRUE(app->screen() == Screen::start);
}

TEST_F(TrainerWindow, AMachineWithoutADisplayGetsASentence) {
    const Outcome play = call("play --no-record --no-sound",
                              "env -u DISPLAY -u WAYLAND_DISPLAY SDL_VIDEODRIVER=x11 XDG_CONFIG_HOME=" + folder.path());
    EXPECT_EQ(play.code, 1);
    EXPECT_NE(play.text.find("no window can be opened"), std::string::npos) << play.text;
    EXPECT_TRUE(one_sentence(play));
}

TEST_F(TrainerWindow, PrintConfigIsASettingsFile) {
    const Outcome print = call("play --print-config", "XDG_CONFIG_HOME=" + folder.path());
    EXPECT_EQ(print.code, 0);
    EXPECT_EQ(settings_toml(read_settings(folder.write("printed.toml", print.text))), print.text);
}

TEST_F(TrainerWindow, AReallyKilledTrainerLosesAtMostASecond) {
    // The program itself, on its own threads, ended without a warning.
    const std::string run = folder.path("run");
    const std::string environment = "env SDL_VIDEODRIVER=dummy CATHLAB_DATA_DIR=" + context.data_root +
                                    " CATHLAB_CACHE_DIR=" + context.cache_folder + " XDG_CONFIG_HOME=" + folder.path();
    // As soon as it has kept a good second; on a machine with other work that may take a while.
    const std::string kept = "$(cat " + run + "/trace.csv 2>/dev/null | wc -l)";
    const std::string killer = " & player=$!; for i in $(seq 600); do [ " + kept +
                               " -gt 60 ] && break; kill -0 $player 2>/dev/null || break; sleep 0.1; done; "
                               "kill -KILL $player; wait $player";
    call("play " + folder.path("data/scenes/small.toml") + " --no-gl --no-sound --size 320x180 --out " + run +
             " >/dev/null" + killer,
         environment);
    ASSERT_TRUE(std::filesystem::exists(run + "/manifest.json"));
    const Outcome replay = call("replay " + run + " --verify", "CATHLAB_DATA_DIR=" + context.data_root);
    EXPECT_EQ(replay.code, 0) << replay.text;
    const RunRecord record = read_run(run);
    EXPECT_FALSE(record.manifest.complete);
    EXPECT_GT(record.steps, 10);
}

}  // namespace
}  // namespace cathlab::play
