#include "play/play_app.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "core/errors.h"
#include "core/log.h"
#include "hud/hud.h"
#include "hud/hud_data.h"
#include "scene/load_scene.h"
#include "task/scene_task.h"

namespace cathlab::play {
namespace fs = std::filesystem;
namespace {

// Where a turn is cheap (a GPU), sixty a second; elsewhere they come with the pictures, so that none waits for a turn
// that shows nothing new.
constexpr auto plain_turn = std::chrono::microseconds(16667);
constexpr auto picture_turn = std::chrono::milliseconds(30);
constexpr auto cheap_turn = std::chrono::milliseconds(4);
constexpr Uint32 new_picture = SDL_USEREVENT;  // pushed by the painter

WindowOptions window_options(const PlayOptions& options, const Settings& settings) {
    WindowOptions out = options.window;
    out.title = "cathlab";
    out.alone = options.threaded;
    out.fullscreen = out.fullscreen || settings.view.fullscreen;
    return out;
}

}  // namespace

PlayApp::PlayApp(PlayOptions options, const AppContext& context)
    : options_(std::move(options)),
      context_(context),
      settings_([&] {
          LoadedSettings loaded = load_settings(options_.settings);
          settings_fault_ = loaded.message;
          return loaded.settings;
      }()),
      window_(window_options(options_, settings_)),
      pads_(data_home()),
      loader_(context),
      expert_(context),
      choices_(find_choices(context.data_root)) {
    fullscreen_ = settings_.view.fullscreen = settings_.view.fullscreen || options_.window.fullscreen;
    if (!options_.silent) tones_.emplace();
    for (const std::string& note : {settings_fault_, window_.note(), pads_.fault(), tones_ ? tones_->fault() : ""})
        if (!note.empty()) {
            say(note);
            log::warn(note);
        }
    if (!options_.study.empty()) {
        desk_.emplace(options_.study, options_.participant, context);
        to_study();
    } else if (options_.replay.empty()) {
        const SceneSpec scene = load_scene(options_.scene, options_.overlays, context.data_root);
        setup_ = free_play_ = setup_of(scene);
        if (!options_.task.empty()) {
            choose_task(find_task(options_.task, context.data_root), setup_);
        } else if (const auto own = task_of(scene)) {  // the scene sets a task itself
            const TaskScene task{scene.name, scene.title.empty() ? scene.name : scene.title, scene, *own};
            std::erase_if(choices_.tasks, [&](const TaskScene& other) { return other.id == task.id; });
            choices_.tasks.insert(choices_.tasks.begin(), task);
            choose_task(task, setup_);
        } else if (!options_.at_once && !choices_.tasks.empty()) {
            choose_task(choices_.tasks.front(), setup_);
        }
        setup_.difficulty = options_.difficulty.value_or(Difficulty::guided);
    }
    lay_out();
    if (options_.at_once || !options_.replay.empty()) begin_load(options_.out);
}

PlayApp::~PlayApp() {
    painter_.reset();
    sim_.reset();
}

void PlayApp::say(const std::string& text, double shown_s) {
    if (text.empty()) return;
    said_.push_back(text);
    for (Toast& toast : toasts_) {
        if (toast.text != text) continue;
        toast.until_s = now_s_ + shown_s;
        return;
    }
    toasts_.push_back({text, now_s_ + shown_s});
    if (toasts_.size() > 4) toasts_.erase(toasts_.begin());
}

void PlayApp::begin_load(const std::string& folder) {
    LoadRequest request;
    request.setup = asked_ = setup_;
    request.run = settings_.run;
    request.run.record = settings_.run.record && options_.record;
    request.folder = folder;
    if (desk_) {
        request.run.record = true;
        request.folder = desk_->begin();
        request.seed = desk_->seed();
        request.trial = trial_json(*desk_->next());
    }
    request.replay = options_.replay;
    screen_ = Screen::loading;
    panels_.clear();
    loader_.start(request, options_.threaded);
}

void PlayApp::begin_session(std::unique_ptr<Simulation> simulation) {
    inner_allowed_ = !simulation->watch().task() || simulation->watch().task()->inner_view;
    simulation->pilot().set_follows(asked_.difficulty != Difficulty::exam);
    simulation->pilot().allow_roadmap(roadmap_allowed());
    if (!simulation->recording_fault().empty()) say(simulation->recording_fault());
    const std::string instructions = simulation->watch().task() ? simulation->watch().task()->instructions : "";
    sim_ = std::make_unique<SimThread>(std::move(simulation), options_.threaded);
    painter_ = std::make_unique<Painter>(
        sim_->shots(), options_.threaded, [] { return make_gl_target(); },
        [] {
            SDL_Event wake{};
            wake.type = new_picture;
            SDL_PushEvent(&wake);
        });
    clip_.clear();
    fluoroscopy_ = inner_ = outer_ = kept_ = Image8();
    stamps_.clear();
    drawn_stamp_ = 0;
    input_.release_keys();
    screen_ = Screen::play;
    panels_.clear();
    side_ = views_allowed() ? Side::inner : Side::kept;
    looked_s_ = {};
    looked_until_s_ = 0.0;
    if (!options_.replay.empty()) {
        if (seek_to_ > 0) sim_->run_to(seek_to_);
        seek_to_ = -1;
        return;
    }
    if (!instructions.empty()) say(instructions, 10.0);
    say("X-rays: " + settings_.bindings.labels(Control::fluoroscopy, pads_.any()) +
        "   push: " + settings_.bindings.labels(Control::advance, pads_.any()) +
        "   all controls: " + settings_.bindings.labels(Control::help, false));
}

void PlayApp::end_session(bool with_result) {
    if (!sim_) return;
    Simulation& simulation = sim_->stop();
    painter_.reset();
    const bool reached = simulation.goal().outcome == GoalTracker::Outcome::reached;
    if (with_result && options_.replay.empty()) make_result(simulation, reached);
    simulation.finish(true);
    if (desk_ && with_result) keep_trial(simulation.recording_fault().empty());
    if (with_result && !asked_.task.empty()) look_for_expert();
    pads_.rumble(0.0, 0.0);
    sim_.reset();
    status_ = {};
    panels_.clear();
    toasts_.clear();
    ui_feed_.release();
    screen_ = with_result && options_.replay.empty() ? Screen::result : Screen::start;
    if (!options_.replay.empty()) quit_ = true;
}

void PlayApp::open(Panel panel) {
    if (screen_ == Screen::play && panels_.empty() && sim_) {
        was_paused_ = sim_->paused();
        sim_->set_paused(true);
    }
    panels_.push_back(panel);
    stamps_.clear();
    toasts_.clear();  // what was said about playing would lie over the panel
    ui_feed_.release();
}

void PlayApp::go_on() {
    if (!panels_.empty()) panels_.pop_back();
    ui_feed_.release();
    if (panels_.empty() && sim_) sim_->set_paused(was_paused_);
}

void PlayApp::follow(Wish wish) {
    switch (wish) {
        case Wish::none: break;
        case Wish::start: begin_load(""); break;
        case Wish::close:
            if (screen_ == Screen::questions && panels_.empty()) {
                keep_answers();
                to_study();
                break;
            }
            go_on();
            break;
        case Wish::resume: go_on(); break;
        case Wish::save:
            try {
                save_settings(settings_, options_.settings);
                say("settings kept in " + options_.settings);
            } catch (const UserError& error) {
                say(error.what());
            }
            go_on();
            break;
        case Wish::again:
            end_session(false);
            begin_load("");
            break;
        case Wish::end: end_session(true); break;
        case Wish::to_start:
            end_session(false);
            screen_ = Screen::start;
            break;
        case Wish::settings: open(Panel::settings); break;
        case Wish::help: open(Panel::help); break;
        case Wish::expert:
            result_.expert_wanted = false;
            flying_ = true;
            expert_.fly(flown_scene_, flown_models_, experts_home(), options_.threaded);
            break;
        case Wish::questions:
            if (result_.folder.empty())
                to_study();
            else
                screen_ = Screen::questions;
            break;
        case Wish::skip:
            questions_.answers.skipped = true;
            keep_answers();
            to_study();
            break;
        case Wish::quit: quit_ = true; break;
    }
}

void PlayApp::act_on_time(Control control) {
    if (control == Control::slower) sim_->set_time_scale(std::max(0.1, 0.5 * sim_->time_scale()));
    if (control == Control::faster) sim_->set_time_scale(std::min(4.0, 2.0 * sim_->time_scale()));
    if (control == Control::reset && options_.replay.empty()) follow(Wish::again);
}

void PlayApp::act(Control control) {
    switch (control) {
        case Control::menu: open(Panel::pause); break;
        case Control::help: open(Panel::help); break;
        case Control::pause: sim_->set_paused(!sim_->paused()); break;
        case Control::single_step:
            if (sim_->paused()) sim_->single_steps(1);
            break;
        case Control::slower:
        case Control::faster:
        case Control::reset:
            if (desk_) {
                say("not in a trial of a study");
                break;
            }
            act_on_time(control);
            break;
        case Control::sound:
            settings_.sound.enabled = !settings_.sound.enabled;
            say(settings_.sound.enabled ? "Sound on" : "Sound off");
            break;
        case Control::fullscreen: settings_.view.fullscreen = !settings_.view.fullscreen; break;
        case Control::view: next_side(); break;
        case Control::reference:
            if (fluoroscopy_.rgb.empty()) say("there is no picture yet to keep: X-rays first");
            break;  // what is kept comes with the step that knows of it, so that a replay keeps it, too
        case Control::roadmap:
            if (!roadmap_allowed()) say("no roadmap at this difficulty");
            break;
        case Control::clip: save_clip(); break;
        case Control::screenshot: shot_wanted_ = true; break;
        default: break;  // the pilot's
    }
}

void PlayApp::hands() {
    const Controls before = evaluated_;
    evaluated_ = input_.evaluate(settings_);
    const bool steered = steering();
    std::array<bool, control_count> pressed{};
    for (std::size_t i = 0; i < control_count; ++i) {
        pressed[i] = evaluated_.presses[i] != before.presses[i];
        if (steered && pressed[i]) ++controls_.presses[i];
    }
    const std::array<double, control_count> last = controls_.value;
    if (steered)
        controls_.value = evaluated_.value;
    else
        controls_.value.fill(0.0);
    bool changed = controls_.value != last;
    if (steered) {
        for (std::size_t i = 0; i < control_count && sim_ && screen_ == Screen::play; ++i) {
            if (!pressed[i]) continue;
            changed = true;
            act(static_cast<Control>(i));
        }
    } else if (panel() == Panel::pause && (pressed[static_cast<std::size_t>(Control::menu)] ||
                                           pressed[static_cast<std::size_t>(Control::pause)])) {
        go_on();
    } else if (panel() == Panel::help &&
               (pressed[static_cast<std::size_t>(Control::help)] || pressed[static_cast<std::size_t>(Control::menu)])) {
        go_on();
    } else if (panel() == Panel::settings && pressed[static_cast<std::size_t>(Control::menu)] &&
               !settings_view_.listening && !ui_->wants_text()) {
        go_on();
    }
    if (!sim_) return;
    if (changed && stamps_.size() < 64) stamps_.emplace_back(++stamp_, moved_at_.value_or(Clock::now()));
    moved_at_.reset();
    sim_->post(controls_, settings_.input, stamp_);
}

void PlayApp::feed(const SDL_Event& event) {
    if (event.type == new_picture) return;
    if (!moved_at_ && event.type >= SDL_KEYDOWN && event.type < SDL_FINGERDOWN)
        moved_at_ = Clock::now() - std::chrono::milliseconds(SDL_GetTicks() - event.common.timestamp);
    if (event.type == SDL_QUIT) quit_ = true;
    if (event.type == SDL_WINDOWEVENT && event.window.event == SDL_WINDOWEVENT_CLOSE) quit_ = true;
    const std::string note = pads_.feed(event);
    say(note);
    ui_feed_.feed(event, 1.0F, 1.0F);
    input_.feed(event, ui_->wants_mouse(), ui_->wants_text());
}

void PlayApp::poll() {
    SDL_Event event;
    while (SDL_PollEvent(&event) != 0) feed(event);
    if (stop_wanted()) quit_ = true;
}

std::string PlayApp::new_file(const std::string& stem, const std::string& ending) const {
    std::string folder = loader_.folder();
    if (folder.empty()) folder = data_home();
    std::error_code error;
    fs::create_directories(folder, error);
    std::string path;
    for (int i = 1; path.empty() || fs::exists(path, error); ++i)
        path = folder + "/" + stem + "-" + std::to_string(i) + ending;
    return path;
}

void PlayApp::screenshot() {
    shot_wanted_ = false;
    try {
        Image8 picture;
        window_.read(picture);
        const std::string path = new_file("screenshot", ".png");
        write_png(path, picture);
        say("saved " + path);
    } catch (const UserError& error) {
        say(error.what());
    }
}

void PlayApp::save_clip() {
    constexpr double clip_fps = 15.0;
    if (clip_.count() == 0)
        say("there is no fluoroscopy yet for a clip: X-rays first");
    else if (clip_.save(new_file("clip", ".mp4"), clip_fps))
        say("the last seconds of fluoroscopy are being saved");
}

void PlayApp::seek(std::int64_t step) {
    if (!sim_) return;
    if (step > status_.steps) {
        sim_->run_to(step);
    } else if (step < status_.steps) {  // back means again from the start
        painter_.reset();
        sim_.reset();
        seek_to_ = step;
        begin_load("");
    }
}

bool PlayApp::frame(double dt) {
    now_s_ += dt;
    std::erase_if(toasts_, [&](const Toast& toast) { return toast.until_s < now_s_; });
    poll();
    if (quit_) return false;
    if (screen_ == Screen::loading && !loader_.busy()) {
        auto simulation = loader_.take();
        say(loader_.error());
        if (simulation) {
            begin_session(std::move(simulation));
        } else {
            log::error(loader_.error());
            if (options_.at_once || !options_.replay.empty()) throw UserError(loader_.error());
            screen_ = desk_ ? Screen::study : Screen::start;
        }
    }
    hands();
    if (settings_.view.fullscreen != fullscreen_) {
        fullscreen_ = settings_.view.fullscreen;
        window_.set_fullscreen(fullscreen_);
    }
    say(clip_.report());
    if (flying_) {
        result_.expert_note = "an expert is on the way: " + time_text(expert_.flown_s());
        if (!expert_.busy()) {
            flying_ = false;
            result_.expert_note = expert_.fault();
            if (screen_ == Screen::result) result_.expert = Expert::find(flown_scene_, experts_home());
        }
    }
    if (sim_) {
        if (!options_.threaded) sim_->run_for(dt);
        const std::string fault = status_.recording_fault;
        const double references = status_.channels.references;
        status_ = sim_->status();
        if (status_.channels.references > references) keep_picture();
        if (status_.recording_fault != fault) say(status_.recording_fault);
        if (!status_.fault.empty()) say("the simulation has stopped: " + status_.fault);
    }
    lay_out();
    if (painter_ && !options_.threaded) painter_->paint();
    note_aids();
    take_pictures();
    if (screen_ == Screen::play && status_.over && options_.replay.empty()) end_session(true);
    if (window_.minimised()) {
        input_.screens_begin();
        ui_feed_.take();
    } else {
        draw_screens(dt);
        draw_window();
    }
    const bool live = screen_ == Screen::play && !status_.paused;
    const Tremble tremble = live ? tremble_of(status_.channels.force_bar, settings_.input.rumble, now_s_) : Tremble{};
    pads_.rumble(tremble.low, tremble.high);
    if (tones_) {
        ToneState tone;
        tone.beam_on = live && status_.channels.beam_on > 0.5;
        tone.force_bar = live ? status_.channels.force_bar : 0.0;
        tones_->play(tone, settings_.sound);
    }
    return !quit_;
}

// What hands do is handed on at once; the screens are drawn again when there is a new picture, or after a while.
void PlayApp::rest(Clock::time_point begin) {
    if (screen_ != Screen::play) {
        std::this_thread::sleep_until(begin + plain_turn);
        return;
    }
    const bool quick = painter_ && layout_.side.width > 0 && side_ != Side::kept;
    const auto next = begin + (quick && Clock::now() - begin > cheap_turn ? picture_turn : plain_turn);
    while (!quit_ && screen_ == Screen::play && !painter_->has_quick()) {
        const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(next - Clock::now()).count();
        if (left <= 0 || SDL_WaitEventTimeout(nullptr, static_cast<int>(left)) == 0) break;
        poll();
        hands();
    }
}

bool PlayApp::turn() {
    const auto begin = Clock::now();
    const double passed = turned_ ? std::chrono::duration<double>(begin - *turned_).count() : 0.0;
    turned_ = begin;
    if (!frame(passed)) return false;
    turn_cost_.add(std::chrono::duration<double>(Clock::now() - begin).count());
    rest(begin);
    return true;
}

void PlayApp::run() {
    while (turn()) {
    }
    end_session(false);
}

}  // namespace cathlab::play
