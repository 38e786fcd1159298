// Sessions from the first screen to the last, by keyboard alone and by pad alone.
#include <sys/resource.h>

#include <algorithm>
#include <csignal>

#include "app/program.h"
#include "play/play_bench.h"
#include "record/run_reader.h"

namespace cathlab::play {
namespace {

using Trainer = PlayBench;

bool heard(const PlayApp& app, const std::string& part) {
    return std::any_of(app.said().begin(), app.said().end(),
                       [&](const std::string& text) { return text.find(part) != std::string::npos; });
}

Outcome verify(const std::string& run, const AppContext& context) {
    return call("replay " + run + " --verify", "CATHLAB_DATA_DIR=" + context.data_root);
}

TEST_F(Trainer, AKeyboardAloneGoesFromTheStartToTheResultAndOnAgain) {
    start(false);
    frames(3);
    tap(SDL_SCANCODE_RETURN);
    ASSERT_TRUE(leave(Screen::start, 5));
    ASSERT_TRUE(leave(Screen::loading, 5));
    key(SDL_SCANCODE_SPACE, true);
    key(SDL_SCANCODE_W, true);
    for (int i = 0; i < 500 && app->screen() == Screen::play; ++i) {
        frames(1);
        if (app->simulation() != nullptr && status().goal.inside) key(SDL_SCANCODE_W, false);
    }
    ASSERT_TRUE(app->screen() == Screen::result);
    EXPECT_EQ(app->result().outcome, "Reached.");
    EXPECT_GT(app->result().score.value_or(0.0), 50.0);
    EXPECT_GT(app->result().metrics.fluoroscopy_time_s, 0.5);
    key(SDL_SCANCODE_SPACE, false);
    frames(3);
    const std::string first = app->result().folder;
    const Outcome replay = verify(first, context);
    EXPECT_EQ(replay.code, 0) << replay.text;
    tap(SDL_SCANCODE_RETURN);  // again
    ASSERT_TRUE(leave(Screen::result, 5));
    ASSERT_TRUE(leave(Screen::loading, 5));
    EXPECT_NE(app->run_folder(), first);
    EXPECT_TRUE(app->screen() == Screen::play);
}

TEST_F(Trainer, APadAloneGoesFromTheStartToTheResult) {
    start(false);
    VirtualPad pad;
    frames(3);
    pad.button(SDL_CONTROLLER_BUTTON_A, true);
    frames(2);
    pad.button(SDL_CONTROLLER_BUTTON_A, false);
    frames(2);
    ASSERT_TRUE(leave(Screen::start, 5));
    ASSERT_TRUE(leave(Screen::loading, 5));
    pad.axis(SDL_CONTROLLER_AXIS_TRIGGERRIGHT, 1.0);
    pad.axis(SDL_CONTROLLER_AXIS_LEFTY, -1.0);
    for (int i = 0; i < 500 && app->screen() == Screen::play; ++i) {
        frames(1);
        if (app->simulation() != nullptr && status().goal.inside) pad.axis(SDL_CONTROLLER_AXIS_LEFTY, 0.0);
    }
    ASSERT_TRUE(app->screen() == Screen::result);
    EXPECT_EQ(app->result().outcome, "Reached.");
    EXPECT_GT(pad.rumbles, 0);
    EXPECT_EQ(verify(app->result().folder, context).code, 0);
}

TEST_F(Trainer, TheConsoleIsRecordedSoThatAReplayHasTheSameDoseAndPictures) {
    start(true, "");
    key(SDL_SCANCODE_SPACE, true);
    frames(10);
    tap(SDL_SCANCODE_X);  // cine
    EXPECT_EQ(status().channels.acquisition, 1.0);
    frames(10);
    tap(SDL_SCANCODE_X);  // DSA
    EXPECT_EQ(status().channels.acquisition, 2.0);
    key(SDL_SCANCODE_C, true);
    frames(20);
    key(SDL_SCANCODE_C, false);
    tap(SDL_SCANCODE_R);
    EXPECT_EQ(status().channels.references, 1.0);
    EXPECT_TRUE(app->side() == Side::kept);
    tap(SDL_SCANCODE_X);  // and fluoroscopy again, at low dose, over the roadmap
    EXPECT_EQ(status().channels.acquisition, 0.0);
    tap(SDL_SCANCODE_B);
    tap(SDL_SCANCODE_B);
    EXPECT_EQ(status().input.fluoroscopy_level, 0.0);
    tap(SDL_SCANCODE_Q);
    EXPECT_EQ(status().channels.roadmap, 1.0);
    key(SDL_SCANCODE_LEFTBRACKET, true);
    frames(20);
    key(SDL_SCANCODE_LEFTBRACKET, false);
    EXPECT_LT(status().channels.collimator_width, 0.9);
    EXPECT_EQ(status().channels.collimator_height, 1.0);
    tap(SDL_SCANCODE_N);
    frames(60);
    EXPECT_GT(std::abs(status().channels.primary_angle_deg) + std::abs(status().channels.secondary_angle_deg), 1.0);
    const Channels played = status().channels;
    EXPECT_GE(played.exposure_series, 4.0);
    const std::string run = app->run_folder();
    app.reset();
    EXPECT_EQ(verify(run, context).code, 0);
    PlayOptions again = options();
    again.replay = run;
    app = std::make_unique<PlayApp>(again, context);
    for (int i = 0; i < 400 && (app->simulation() == nullptr || !status().over); ++i) frames(1);
    EXPECT_EQ(status().channels.air_kerma_mgy, played.air_kerma_mgy);
    EXPECT_EQ(status().channels.dose_area_product_gycm2, played.dose_area_product_gycm2);
    EXPECT_EQ(status().channels.exposures, played.exposures);
    EXPECT_EQ(status().channels.contrast_injected_ml, played.contrast_injected_ml);
    EXPECT_TRUE(app->side() == Side::kept);  // the reference was kept in the replay, too
}

TEST_F(Trainer, APadChoosesWhatIsExposedAndTheRoadmap) {
    start(true, "");
    VirtualPad pad;
    frames(3);
    const auto press = [&](SDL_GameControllerButton button) {
        pad.button(button, true);
        frames(2);
        pad.button(button, false);
        frames(2);
    };
    press(SDL_CONTROLLER_BUTTON_A);
    EXPECT_EQ(status().input.acquisition, 1.0);
    press(SDL_CONTROLLER_BUTTON_X);
    EXPECT_EQ(status().input.roadmap, 1.0);
}

TEST_F(Trainer, AnExamHasNoRoadmapAndSaysSo) {
    start(false, "");
    app->setup().difficulty = Difficulty::exam;
    frames(3);
    tap(SDL_SCANCODE_RETURN);
    ASSERT_TRUE(leave(Screen::start, 5));
    frames(3);
    ASSERT_TRUE(app->screen() == Screen::play);
    tap(SDL_SCANCODE_Q);
    EXPECT_EQ(status().input.roadmap, 0.0);
    EXPECT_TRUE(heard(*app, "no roadmap"));
}

TEST_F(Trainer, APadThatIsPulledOutStopsTheDeviceAndSaysSo) {
    start();
    {
        VirtualPad pad;
        frames(2);
        pad.axis(SDL_CONTROLLER_AXIS_LEFTY, -1.0);
        frames(10);
        EXPECT_GT(status().channels.wire_insertion_mm, 52.0);
        pad.unplug();
        frames(2);
        EXPECT_TRUE(heard(*app, "unplugged"));
        const double stopped = status().channels.wire_insertion_mm;
        frames(20);
        EXPECT_NEAR(status().channels.wire_insertion_mm, stopped, 1e-9);
    }
    VirtualPad again;  // and a pad that comes back works
    frames(2);
    again.axis(SDL_CONTROLLER_AXIS_LEFTY, 1.0);
    const double before = status().channels.wire_insertion_mm;
    frames(10);
    EXPECT_LT(status().channels.wire_insertion_mm, before - 1.0);
}

TEST_F(Trainer, ThePadTremblesWithTheForceAndNotWithout) {
    start(true, "");
    VirtualPad pad;
    frames(5);
    EXPECT_EQ(pad.low, 0);
    pad.axis(SDL_CONTROLLER_AXIS_LEFTY, -1.0);
    double most = 0.0;
    for (int i = 0; i < 400 && most < 0.3; ++i) {
        frames(1);
        most = status().channels.force_bar;
    }
    ASSERT_GE(most, 0.3);
    frames(1);
    EXPECT_GT(pad.low, 65535 * 0.2);
}

TEST_F(Trainer, ARemappedKeySurvivesARestart) {
    start();
    app->open(Panel::settings);
    app->select_tab(1);
    frames(2);
    app->settings().bindings.of(Control::advance).clear();
    app->settings().bindings.bind(Control::advance, parse_source("key:U"));
    app->go_on();
    save_settings(app->settings(), folder.path("config/play.toml"));
    start();
    key(SDL_SCANCODE_W, true);
    frames(10);
    const double before = status().channels.wire_insertion_mm;
    EXPECT_NEAR(before, 50.0, 0.2);
    key(SDL_SCANCODE_U, true);
    frames(10);
    EXPECT_GT(status().channels.wire_insertion_mm, before + 2.0);
}

TEST_F(Trainer, TheMenuStopsTimeAndTheHands) {
    start();
    key(SDL_SCANCODE_W, true);
    frames(5);
    tap(SDL_SCANCODE_ESCAPE);
    ASSERT_TRUE(app->panel() == Panel::pause);
    const auto steps = status().steps;
    frames(20);
    EXPECT_EQ(status().steps, steps);
    tap(SDL_SCANCODE_ESCAPE);
    EXPECT_TRUE(app->panel() == Panel::none);
    frames(5);
    EXPECT_GT(status().steps, steps);
}

TEST_F(Trainer, PauseSingleStepAndTimeScaleDoWhatTheySay) {
    start();
    tap(SDL_SCANCODE_P);
    frames(2);
    const auto steps = status().steps;
    tap(SDL_SCANCODE_O);
    EXPECT_EQ(status().steps, steps + 1);
    tap(SDL_SCANCODE_P);
    const auto running = status().steps;
    frames(20);
    EXPECT_EQ(status().steps, running + 20);
    tap(SDL_SCANCODE_MINUS);
    const auto slow = status().steps;
    frames(20);
    EXPECT_EQ(status().steps, slow + 10);
    tap(SDL_SCANCODE_EQUALS);
    tap(SDL_SCANCODE_EQUALS);
    const auto fast = status().steps;
    frames(10);
    EXPECT_EQ(status().steps, fast + 20);
}

TEST_F(Trainer, AnEndWithoutAWarningLosesAtMostTheLastSteps) {
    // The folder as it lies there while the session goes on, as after a kill -9.
    start();
    key(SDL_SCANCODE_W, true);
    frames(73);
    const auto played = status().steps;
    const std::string copy = folder.path("killed");
    std::filesystem::copy(app->run_folder(), copy, std::filesystem::copy_options::recursive);
    const RunRecord run = read_run(copy);
    EXPECT_FALSE(run.manifest.complete);
    EXPECT_GE(run.steps, played - 50);  // one second
    const Outcome replay = verify(copy, context);
    EXPECT_EQ(replay.code, 0) << replay.text;
}

TEST_F(Trainer, AReplayShowsTheSameRunAndEnds) {
    start();
    key(SDL_SCANCODE_W, true);
    frames(40);
    const Channels played = status().channels;
    const std::string run = app->run_folder();
    app.reset();
    PlayOptions again = options();
    again.replay = run;
    app = std::make_unique<PlayApp>(again, context);
    frames(1);
    ASSERT_TRUE(app->screen() == Screen::play);
    key(SDL_SCANCODE_S, true);  // a hand on the keys changes nothing
    frames(200);
    EXPECT_TRUE(status().over);
    EXPECT_EQ(status().channels.wire_insertion_mm, played.wire_insertion_mm);
    EXPECT_EQ(status().channels.wire_tip_z_mm, played.wire_tip_z_mm);
}

TEST_F(Trainer, AFullDiskEndsTheRecordingAndNotTheSession) {
    start();
    frames(5);
    ASSERT_TRUE(app->simulation() != nullptr);
    const auto before = status().steps;
    // The next flush meets a file that cannot grow: the folder's files are replaced by a full device.
    rlimit small{4096, RLIM_INFINITY}, old{};
    ::getrlimit(RLIMIT_FSIZE, &old);
    std::signal(SIGXFSZ, SIG_IGN);
    small.rlim_max = old.rlim_max;
    ::setrlimit(RLIMIT_FSIZE, &small);
    frames(80);
    ::setrlimit(RLIMIT_FSIZE, &old);
    EXPECT_TRUE(heard(*app, "the recording has ended"));
    EXPECT_EQ(status().steps, before + 80);
}

TEST_F(Trainer, AnAnatomyThatCannotBeBuiltLeavesTheStartScreenWithTheReason) {
    folder.write("data/assets/anatomy/broken.toml", "schema = 1\nname = \"broken\"\n");
    start(false);
    frames(3);
    app->setup().anatomy = "broken";
    tap(SDL_SCANCODE_RETURN);
    leave(Screen::loading, 5);
    frames(2);
    EXPECT_TRUE(app->screen() == Screen::start);
    EXPECT_TRUE(heard(*app, "broken"));
    app->setup().anatomy = "fork";  // and another one plays
    tap(SDL_SCANCODE_RETURN);
    EXPECT_TRUE(leave(Screen::start, 5));
    frames(3);
    EXPECT_TRUE(app->screen() == Screen::play);
}

TEST_F(Trainer, DifficultyMovesTheForceLimitsAndTheViewsAndTheRunIsScoredByThem) {
    const auto begin = [&](Difficulty difficulty) {
        start(false, "wide");
        app->setup().difficulty = difficulty;
        frames(3);
        tap(SDL_SCANCODE_RETURN);
        ASSERT_TRUE(leave(Screen::start, 5));
        frames(3);
        ASSERT_TRUE(app->screen() == Screen::play);
    };
    double limit[3] = {};
    for (const Difficulty difficulty : {Difficulty::guided, Difficulty::standard, Difficulty::exam}) {
        begin(difficulty);
        limit[static_cast<int>(difficulty)] = app->simulation()->stop().scene().wall.force_limit_share;
        EXPECT_EQ(app->side() == Side::kept, difficulty == Difficulty::exam);
    }
    EXPECT_EQ(limit[0], 1.25);
    EXPECT_EQ(limit[1], 1.0);
    EXPECT_EQ(limit[2], 0.75);
    begin(Difficulty::exam);
    key(SDL_SCANCODE_W, true);
    for (int i = 0; i < 500 && app->screen() == Screen::play; ++i) {
        frames(1);
        if (app->simulation() != nullptr && status().goal.inside) key(SDL_SCANCODE_W, false);
    }
    ASSERT_TRUE(app->screen() == Screen::result);
    frames(2);
    const Outcome score = call("score " + app->result().folder, "CATHLAB_DATA_DIR=" + context.data_root);
    EXPECT_EQ(score.code, 0) << score.text;
    char text[32];
    std::snprintf(text, sizeof text, "score %.1f of 100", app->result().score.value_or(-1.0));
    EXPECT_NE(score.text.find(text), std::string::npos) << score.text;
}

}  // namespace
}  // namespace cathlab::play
