// Sticks, keys, bindings, settings, trembling and tones, each by itself.
#include <cmath>

#include "play/pads.h"
#include "play/play_bench.h"
#include "play/settings.h"
#include "play/stick.h"
#include "play/tones.h"

namespace cathlab::play {
namespace {

TEST(Stick, IsAtRestWithinItsDeadZoneWhateverTheDirection) {
    const StickShape shape{0.2, 0.05, 1.6};
    for (int i = 0; i < 16; ++i) {
        const double a = 0.39 * i;
        const StickPlace place = shaped(shape, StickPlace{0.199 * std::cos(a), 0.199 * std::sin(a)});
        EXPECT_EQ(place.x, 0.0);
        EXPECT_EQ(place.y, 0.0);
    }
}

TEST(Stick, BeginsAtZeroBehindTheDeadZoneIsFullBeforeTheRimAndPointsWhereItPoints) {
    const StickShape shape{0.2, 0.05, 1.6};
    EXPECT_LT(shaped(shape, 0.21), 0.01);
    EXPECT_EQ(shaped(shape, 0.95), 1.0);
    EXPECT_EQ(shaped(shape, 1.0), 1.0);
    EXPECT_EQ(shaped(shape, -1.0), -1.0);
    EXPECT_NEAR(shaped(shape, 0.2 + 0.75 * 0.5), std::pow(0.5, 1.6), 1e-12);
    const StickPlace place = shaped(shape, StickPlace{0.3, -0.4});
    EXPECT_NEAR(std::hypot(place.x, place.y), shaped(shape, 0.5), 1e-12);
    EXPECT_NEAR(place.x / place.y, -0.75, 1e-12);
}

TEST(Bindings, EveryDefaultIsReadWrittenAndReadAgain) {
    for (const ControlInfo& info : control_table())
        for (const std::string_view text : info.sources) {
            EXPECT_EQ(source_text(parse_source(text)), text);
            EXPECT_FALSE(source_label(parse_source(text)).empty());
        }
}

TEST(Bindings, NoPlaceMovesTwoControls) {
    std::vector<std::pair<Source::Kind, int>> seen;
    for (const auto& sources : default_bindings().sources)
        for (const Source& source : sources) {
            const std::pair place(source.kind, source.code);
            EXPECT_EQ(std::count(seen.begin(), seen.end(), place), 0) << source_text(source);
            seen.push_back(place);
        }
}

TEST(Bindings, AWrongPlaceIsASentence) {
    EXPECT_NE(error_sentence([] { parse_source("key:Nonsense"); }).find("key:Nonsense"), std::string::npos);
    EXPECT_NE(error_sentence([] { parse_source("pad:z"); }).find("leftx"), std::string::npos);
    EXPECT_NE(error_sentence([] { parse_source("W"); }).find("key:NAME"), std::string::npos);
}

TEST(SettingsFile, WhatIsSavedIsReadAgain) {
    const TemporaryFolder folder;
    const std::string path = folder.path("a/b/play.toml");
    Settings settings;
    settings.input.advance_mm_s = 12.5;
    settings.input.left_handed = true;
    settings.view.palette = "high-contrast";
    settings.run.participant = "p-01";
    settings.bindings.of(Control::advance).clear();
    settings.bindings.bind(Control::pause, parse_source("pad:lefty:-"));
    save_settings(settings, path);
    const Settings read = read_settings(path);
    EXPECT_EQ(settings_toml(read), settings_toml(settings));
    EXPECT_EQ(read.input.advance_mm_s, 12.5);
    EXPECT_EQ(read.bindings, settings.bindings);
}

TEST(SettingsFile, ABrokenOneIsKeptAsideAndTheDefaultsAreUsed) {
    const TemporaryFolder folder;
    const std::vector<std::string> broken{"[input]\nadvance_mm_s = 4000\n", "[inptu]\n",
                                          "= = =", std::string("\0\1", 2),
                                          "[bindings]\nadvance = [\"key:Nonsense\"]\n"};
    for (const std::string& text : broken) {
        const std::string path = folder.write("play.toml", text);
        const LoadedSettings loaded = load_settings(path);
        EXPECT_NE(loaded.message.find("the defaults are used"), std::string::npos) << text;
        EXPECT_FALSE(std::filesystem::exists(path));
        EXPECT_TRUE(std::filesystem::exists(path + ".broken"));
        EXPECT_EQ(settings_toml(loaded.settings), settings_toml(Settings{}));
    }
    EXPECT_EQ(load_settings(folder.path("none.toml")).message, "");
}

TEST(Trembling, FollowsTheForceAndPulsesFromTheAlarmOn) {
    EXPECT_EQ(tremble_of(0.0, 1.0, 0.0).low, 0.0);
    EXPECT_LT(tremble_of(0.2, 1.0, 0.0).low, tremble_of(0.6, 1.0, 0.0).low);
    EXPECT_EQ(tremble_of(0.6, 1.0, 0.0).high, 0.0);
    EXPECT_GT(tremble_of(0.8, 1.0, 0.0).high, 0.0);
    EXPECT_EQ(tremble_of(0.8, 1.0, 0.2).high, 0.0);  // between two pulses
    EXPECT_EQ(tremble_of(1.2, 1.0, 0.0).low, 1.0);
    EXPECT_EQ(tremble_of(1.2, 0.0, 0.0).low, 0.0);
}

double loudness(const std::vector<float>& samples) {
    double sum = 0.0;
    for (const float s : samples) sum += static_cast<double>(s) * static_cast<double>(s);
    return std::sqrt(sum / static_cast<double>(samples.size()));
}

TEST(ToneMaker, IsSilentWithoutXRaysAndForceAndNeverClicks) {
    SoundSettings settings;
    settings.volume = 1.0;
    ToneMaker maker;
    std::vector<float> samples(4800), all;
    maker.make({false, 0.0}, settings, 48000, samples);
    EXPECT_EQ(loudness(samples), 0.0);
    for (const ToneState& state : {ToneState{true, 0.0}, ToneState{true, 0.9}, ToneState{false, 1.2}, ToneState{}}) {
        maker.make(state, settings, 48000, samples);
        all.insert(all.end(), samples.begin(), samples.end());
        if (state.beam_on || state.force_bar > 0.0) {
            EXPECT_GT(loudness(samples), 0.02);
        }
    }
    float largest = 0.0F;
    for (std::size_t i = 1; i < all.size(); ++i) largest = std::max(largest, std::fabs(all[i] - all[i - 1]));
    EXPECT_LT(largest, 0.12F);
    settings.enabled = false;
    maker.make({true, 1.0}, settings, 48000, samples);
    maker.make({true, 1.0}, settings, 48000, samples);
    EXPECT_LT(loudness(samples), 1e-4);
}

// One control after another: what it moves, and that it stops when it is let go.
using Hand = PlayBench;

struct Moves {
    SDL_Scancode more, less;
    double Channels::*channel;
};

TEST_F(Hand, EachAxisMovesWhatItSaysAndStopsWhenLetGo) {
    const Moves wire[] = {{SDL_SCANCODE_W, SDL_SCANCODE_S, &Channels::wire_insertion_mm},
                          {SDL_SCANCODE_D, SDL_SCANCODE_A, &Channels::wire_rotation_deg},
                          {SDL_SCANCODE_L, SDL_SCANCODE_J, &Channels::primary_angle_deg},
                          {SDL_SCANCODE_I, SDL_SCANCODE_K, &Channels::secondary_angle_deg},
                          {SDL_SCANCODE_PAGEUP, SDL_SCANCODE_PAGEDOWN, &Channels::table_longitudinal_mm},
                          {SDL_SCANCODE_END, SDL_SCANCODE_HOME, &Channels::table_lateral_mm}};
    start(true, "");
    const auto value = [&](const Moves& m) { return status().channels.*m.channel; };
    const auto hold = [&](SDL_Scancode code) {
        key(code, true);
        frames(12);
        key(code, false);
        frames(6);
    };
    for (const Moves& m : wire) {
        const double before = value(m);
        hold(m.more);
        const double between = value(m);
        EXPECT_GT(between, before + 0.5) << SDL_GetScancodeName(m.more);
        frames(10);
        EXPECT_NEAR(value(m), between, 0.05) << SDL_GetScancodeName(m.more);
        hold(m.less);
        EXPECT_LT(value(m), between - 0.5) << SDL_GetScancodeName(m.less);
    }
    tap(SDL_SCANCODE_2);
    frames(1);
    ASSERT_TRUE(status().catheter);
    const Moves catheter[] = {{SDL_SCANCODE_W, SDL_SCANCODE_S, &Channels::catheter_insertion_mm},
                              {SDL_SCANCODE_UP, SDL_SCANCODE_DOWN, &Channels::catheter_distal_bend_deg}};
    for (const Moves& m : catheter) {
        const double before = value(m);
        hold(m.more);
        EXPECT_GT(value(m), before + 0.3) << SDL_GetScancodeName(m.more);
        const double between = value(m);
        hold(m.less);
        EXPECT_LT(value(m), between - 0.3) << SDL_GetScancodeName(m.less);
    }
    tap(SDL_SCANCODE_2);
    frames(1);
    EXPECT_EQ(status().segment, 0);
    const double proximal = status().channels.catheter_proximal_bend_deg;
    hold(SDL_SCANCODE_UP);
    EXPECT_GT(status().channels.catheter_proximal_bend_deg, proximal + 0.3);
    tap(SDL_SCANCODE_1);
    frames(1);
    EXPECT_FALSE(status().catheter);
}

TEST_F(Hand, PedalContrastPrecisionAndStepsDoWhatTheySay) {
    start(true, "");
    key(SDL_SCANCODE_SPACE, true);
    frames(10);
    EXPECT_EQ(status().channels.beam_on, 1.0);
    key(SDL_SCANCODE_SPACE, false);
    frames(3);
    EXPECT_EQ(status().channels.beam_on, 0.0);
    key(SDL_SCANCODE_C, true);
    frames(10);
    key(SDL_SCANCODE_C, false);
    frames(2);
    EXPECT_NEAR(status().channels.contrast_injected_ml, 8.0 * 0.2, 0.33);
    const auto pushed = [&](SDL_Scancode with) {
        const double before = status().channels.wire_insertion_mm;
        if (with != SDL_SCANCODE_UNKNOWN) key(with, true);
        key(SDL_SCANCODE_S, true);
        frames(5);
        key(SDL_SCANCODE_S, false);
        if (with != SDL_SCANCODE_UNKNOWN) key(with, false);
        frames(5);
        return before - status().channels.wire_insertion_mm;
    };
    const double fast = pushed(SDL_SCANCODE_UNKNOWN);
    EXPECT_NEAR(fast, 4.0, 0.9);
    EXPECT_NEAR(pushed(SDL_SCANCODE_LSHIFT), 0.25 * fast, 0.3);
    tap(SDL_SCANCODE_G);
    EXPECT_NEAR(pushed(SDL_SCANCODE_UNKNOWN), 1.0, 0.05);
}

TEST_F(Hand, AToggledPedalStaysDownUntilItIsPressedAgain) {
    start(true, "");
    app->settings().input.toggle_pedals = true;
    tap(SDL_SCANCODE_SPACE);
    frames(10);
    EXPECT_EQ(status().channels.beam_on, 1.0);
    tap(SDL_SCANCODE_SPACE);
    frames(3);
    EXPECT_EQ(status().channels.beam_on, 0.0);
}

TEST_F(Hand, LeftHandedSticksChangeSides) {
    start(true, "");
    app->settings().input.left_handed = true;
    VirtualPad pad;
    frames(2);
    const double before = status().channels.wire_insertion_mm;
    pad.axis(SDL_CONTROLLER_AXIS_RIGHTY, 1.0);
    frames(10);
    EXPECT_LT(status().channels.wire_insertion_mm, before - 1.0);
}

TEST_F(Hand, AWindowThatLosesTheKeyboardLetsGo) {
    start(true, "");
    key(SDL_SCANCODE_S, true);
    frames(5);
    SDL_Event event{};
    event.type = SDL_WINDOWEVENT;
    event.window.event = SDL_WINDOWEVENT_FOCUS_LOST;
    SDL_PushEvent(&event);
    frames(3);
    const double stopped = status().channels.wire_insertion_mm;
    frames(10);
    EXPECT_NEAR(status().channels.wire_insertion_mm, stopped, 1e-6);
}

}  // namespace
}  // namespace cathlab::play
