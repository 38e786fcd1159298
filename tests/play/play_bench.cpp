#include "play/play_bench.h"

#include <fstream>
#include <sstream>

namespace cathlab::play {
namespace {

std::string text_of(const std::string& path) {
    std::ifstream in(path);
    std::ostringstream text;
    text << in.rdbuf();
    return text.str();
}

}  // namespace

void PlayBench::SetUp() {
    const std::string source = CATHLAB_SOURCE_DIR;
    context.data_root = folder.path("data");
    context.cache_folder = folder.path("cache");
    folder.write("data/assets/anatomy/fork.toml", text_of(source + "/scenes/rigs/fork-anatomy.toml") +
                                                      "\n[[landmark]]\nname = \"middle\"\nvessel = \"trunk\"\n"
                                                      "at = \"place\"\nplace_mm = 32.0\n");
    std::filesystem::copy(source + "/assets/devices", folder.path("data/assets/devices"));
    std::string scene = text_of(source + "/scenes/rigs/fork.toml");
    scene.replace(scene.find("fork-anatomy.toml"), 17, "fork");
    folder.write("data/scenes/small.toml", scene);
    const std::string name = "name = \"";
    const auto named = [&](const std::string& as) {
        std::string out = scene;
        const auto at = out.find(name) + name.size();
        return out.replace(at, out.find('"', at) - at, as);
    };
    const auto to_the_middle = [&](const std::string& as, const std::string& region) {
        folder.write("data/scenes/tasks/" + as + ".toml",
                     named(as) + "\n[task]\ninstructions = \"Push.\"\nlandmark = \"middle\"\n" + region +
                         "time_limit_s = 20.0\n[[task.criterion]]\nmetric = \"play_time_s\"\nfull = 2.0\n"
                         "none = 20.0\n");
    };
    to_the_middle("short", "radius_mm = 14.0\nhold_s = 0.5\n");
    to_the_middle("wide", "radius_mm = 20.0\nhold_s = 0.4\n");  // whoever has come there stays there
    folder.write("data/scenes/tasks/wait.toml",
                 named("wait") +
                     "\n[task]\ninstructions = \"Wait.\"\nlandmark = \"middle\"\nradius_mm = 1.0\nhold_s = 50.0\n"
                     "time_limit_s = 30.0\ninner_view = false\n[[task.criterion]]\nmetric = \"play_time_s\"\n"
                     "full = 2.0\nnone = 20.0\n");
}

void PlayBench::TearDown() {
    app.reset();
    SDL_Quit();
}

PlayOptions PlayBench::options() {
    PlayOptions out;
    out.scene = folder.path("data/scenes/small.toml");
    out.settings = folder.path("config/play.toml");
    out.window.plain = driver == "dummy";
    out.window.width = width;
    out.window.height = height;
    out.threaded = false;
    out.silent = true;
    return out;
}

void PlayBench::start(bool at_once, const std::string& task) {
    app.reset();
    SDL_SetHint(SDL_HINT_VIDEODRIVER, driver.c_str());
    PlayOptions wanted = options();
    wanted.task = task;
    wanted.at_once = at_once;
    app = std::make_unique<PlayApp>(wanted, context);
    app->settings().run.folder = folder.path("runs");
    app->settings().run.threads = 1;
    app->settings().view.largest_picture = 128;
    if (at_once) {
        frames(1);
        ASSERT_TRUE(app->screen() == Screen::play);
    }
}

void PlayBench::frames(int count) {
    for (int i = 0; i < count; ++i) ASSERT_TRUE(app->frame(dt));
}

bool PlayBench::leave(Screen screen, int most) {
    for (int i = 0; i < most; ++i) {
        if (app->screen() != screen) return true;
        app->frame(dt);
    }
    return app->screen() != screen;
}

void PlayBench::tap(SDL_Scancode code) {
    key(code, true);
    frames(1);
    key(code, false);
    frames(2);
}

VirtualPad::VirtualPad() {
    SDL_InitSubSystem(SDL_INIT_GAMECONTROLLER);
    SDL_VirtualJoystickDesc desc{};
    desc.version = SDL_VIRTUAL_JOYSTICK_DESC_VERSION;
    desc.type = SDL_JOYSTICK_TYPE_GAMECONTROLLER;
    desc.naxes = SDL_CONTROLLER_AXIS_MAX;
    desc.nbuttons = SDL_CONTROLLER_BUTTON_DPAD_RIGHT + 1;
    desc.button_mask = (1U << desc.nbuttons) - 1U;
    desc.axis_mask = (1U << SDL_CONTROLLER_AXIS_MAX) - 1U;
    desc.name = "Virtual pad";
    desc.userdata = this;
    desc.Rumble = [](void* self, Uint16 low, Uint16 high) {
        auto* pad = static_cast<VirtualPad*>(self);
        pad->low = low;
        pad->high = high;
        ++pad->rumbles;
        return 0;
    };
    index_ = SDL_JoystickAttachVirtualEx(&desc);
    joystick_ = SDL_JoystickOpen(index_);
    EXPECT_NE(joystick_, nullptr) << SDL_GetError();
    // A trigger at rest is at the lower end of its axis.
    axis(SDL_CONTROLLER_AXIS_TRIGGERLEFT, 0.0);
    axis(SDL_CONTROLLER_AXIS_TRIGGERRIGHT, 0.0);
}

VirtualPad::~VirtualPad() {
    unplug();
    SDL_QuitSubSystem(SDL_INIT_GAMECONTROLLER);
}

void VirtualPad::axis(SDL_GameControllerAxis axis, double value) {
    const bool trigger = axis >= SDL_CONTROLLER_AXIS_TRIGGERLEFT;
    const double raw = trigger ? 65535.0 * value - 32768.0 : 32767.0 * value;
    SDL_JoystickSetVirtualAxis(joystick_, axis, static_cast<Sint16>(raw));
}

void VirtualPad::button(SDL_GameControllerButton button, bool down) {
    SDL_JoystickSetVirtualButton(joystick_, button, down ? 1 : 0);
}

void VirtualPad::unplug() {
    if (joystick_ == nullptr) return;
    SDL_JoystickClose(joystick_);
    joystick_ = nullptr;
    for (int i = 0; i < SDL_NumJoysticks(); ++i)
        if (SDL_JoystickIsVirtual(i) == SDL_TRUE) SDL_JoystickDetachVirtual(i);
}

}  // namespace cathlab::play
