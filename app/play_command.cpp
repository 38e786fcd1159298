// cathlab play: the trainer's window.
#include <CLI/CLI.hpp>
#include <cstdio>

#include "commands.h"
#include "core/csv.h"
#include "core/errors.h"
#include "play/measure.h"
#include "play/play_app.h"
#include "play/tour.h"
#include "scene/load_scene.h"

namespace cathlab {
namespace {

struct PlayArguments {
    std::string scene, size;
    std::string difficulty, tour;
    play::PlayOptions options;
    double measure_s = 0.0;
    bool print_config = false, no_record = false;
};

void read_size(const std::string& text, play::WindowOptions& window) {
    const std::string_view size(text);
    const auto cross = size.find('x');
    const auto width = parse_number<int>(size.substr(0, cross));
    const auto height = cross == std::string_view::npos ? std::nullopt : parse_number<int>(size.substr(cross + 1));
    if (!width || !height || *width < 64 || *height < 64 || *width > 16384 || *height > 16384)
        throw UserError("--size '" + text + "': WxH is wanted, 64x64 to 16384x16384", true);
    window.width = *width;
    window.height = *height;
}

void run_play(PlayArguments& arguments, AppContext& context) {
    play::PlayOptions& options = arguments.options;
    const bool own_settings = options.settings.empty();
    if (own_settings) options.settings = play::settings_path();
    if (arguments.print_config) {
        std::fputs(settings_toml(play::read_or_default(options.settings)).c_str(), stdout);
        return;
    }
    if (!arguments.size.empty()) read_size(arguments.size, options.window);
    options.record = !arguments.no_record;
    if (!arguments.scene.empty() && !options.task.empty())
        throw UserError("a task is a scene of its own: give SCENE or --task, not both", true);
    if (!options.study.empty() && options.participant.empty())
        throw UserError("--study wants --participant: who sits at the controls, by pseudonym", true);
    if (!options.study.empty() && (!arguments.scene.empty() || !options.task.empty() || !options.replay.empty()))
        throw UserError("--study chooses the scene itself: no SCENE, --task or --replay with it", true);
    if (!options.study.empty() && arguments.no_record)
        throw UserError("a trial of a study is recorded: --study and --no-record exclude each other", true);
    options.at_once = !arguments.scene.empty();
    if (options.replay.empty() && options.study.empty())
        options.scene = find_scene(arguments.scene.empty() ? "training" : arguments.scene, context.data_root);
    if (arguments.difficulty == "guided") options.difficulty = play::Difficulty::guided;
    if (arguments.difficulty == "standard") options.difficulty = play::Difficulty::standard;
    if (arguments.difficulty == "exam") options.difficulty = play::Difficulty::exam;
    catch_stop_signals();
    if (!arguments.tour.empty()) {
        if (own_settings) options.settings.clear();  // the pictures are the same for everybody
        play::tour(options, context, arguments.tour);
        return;
    }
    if (arguments.measure_s > 0.0) {
        play::measure(options, context, arguments.measure_s);
        return;
    }
    play::PlayApp app(options, context);
    app.run();
    for (const std::string& text : app.said()) std::fprintf(stderr, "%s\n", text.c_str());
}

}  // namespace

void add_play_command(CLI::App& app, AppContext& context) {
    const auto arguments = std::make_shared<PlayArguments>();
    play::PlayOptions& options = arguments->options;
    CLI::App* command = app.add_subcommand("play", "The trainer: a window, a gamepad or a keyboard");
    command->add_option("SCENE", arguments->scene, "begins with it at once; else a start screen");
    command->add_option("--task", options.task, "a task of scenes/tasks, by its name, instead of a scene");
    command->add_option("--overlay", options.overlays, "a file laid over the scene; may be given again")
        ->allow_extra_args(false);
    command->add_option("--difficulty", arguments->difficulty, "how much help there is")
        ->check(CLI::IsMember({"guided", "standard", "exam"}));
    command->add_option("--out", options.out, "the run folder of the first session; else a new one of the user's");
    command->add_flag("--no-record", arguments->no_record, "keep nothing");
    command->add_option("--replay", options.replay, "shows a recorded run, with a time line");
    CLI::Option* study = command->add_option("--study", options.study, "the next trial of a study's participant");
    command->add_option("--participant", options.participant, "who, by pseudonym")->needs(study);
    command->add_option("--size", arguments->size, "of the window, WxH");
    command->add_flag("--fullscreen", options.window.fullscreen, "the whole screen");
    command->add_option("--config", options.settings, "the settings' file; else play.toml in the user's settings");
    command->add_flag("--print-config", arguments->print_config, "print the settings with their meaning, and end");
    command->add_flag("--no-gl", options.window.plain, "draw the window without OpenGL");
    command->add_flag("--no-sound", options.silent, "open no loudspeaker");
    command->add_option("--tour", arguments->tour,
                        "walks through every screen without a display; pictures into a folder");
    command
        ->add_option("--measure", arguments->measure_s,
                     "plays by itself for so many seconds and prints how fast it was")
        ->check(CLI::Range(1.0, 86400.0));
    command->callback([arguments, &context] { run_play(*arguments, context); });
}

}  // namespace cathlab
