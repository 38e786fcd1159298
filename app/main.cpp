// cathlab: one program, one subcommand a file.  Exit codes: 0 done, 1 the work failed, 2 wrong use.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <new>

#include "commands.h"
#include "core/errors.h"
#include "core/log.h"

namespace {

// Mesa takes this from the environment alone; what the user has set stays.  Called before any thread is started.
void draw_on_one_thread() {
    // By itself its rasteriser takes a thread for every processor, which then wait for each other and for the step's
    // threads: a picture of 1024 x 512 is drawn as fast without them.
    ::setenv("LP_NUM_THREADS", "0", 0);
}

int run_program(int argc, char** argv) {
    using namespace cathlab;
    AppContext context;
    context.command_line = shell_command(argc, argv);
    CLI::App app("cathlab: an endovascular trainer and its headless simulator", "cathlab");
    app.set_version_flag("--version", std::string("cathlab ") + CATHLAB_VERSION);
    app.set_help_flag("-h,--help", "This text");
    app.require_subcommand(1);
    app.fallthrough();
    app.footer(
        "Exit codes: 0 done, 1 the work failed, 2 wrong use.\n"
        "CATHLAB_DATA_DIR names the folder of assets and scenes, CATHLAB_CACHE_DIR that of built anatomies.");
    std::string level = "info";
    app.add_option("--log-level", level, "trace, debug, info, warn, error or off")->default_str(level);
    app.parse_complete_callback([&] {
        log::set_level(level);
        context.data_root = find_data_root();
        context.cache_folder = find_cache_folder();
    });
    add_run_command(app, context);
    add_replay_command(app, context);
    add_score_command(app, context);
    add_study_command(app, context);
    add_render_command(app, context);
    add_play_command(app, context);
    add_list_command(app, context);
    add_check_command(app, context);
    add_calibrate_command(app, context);
    add_explain_command(app, context);
    add_bench_command(app, context);
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        return app.exit(error) == 0 ? 0 : 2;  // --help and --version end here too
    }
    return context.exit_code;
}

}  // namespace

int main(int argc, char** argv) {
    draw_on_one_thread();
    try {
        return run_program(argc, argv);
    } catch (const cathlab::UserError& error) {
        std::fprintf(stderr, "cathlab: %s\n", error.what());
        return error.wrong_use() ? 2 : 1;
    } catch (const std::bad_alloc&) {
        std::fprintf(stderr, "cathlab: the memory does not suffice\n");
    } catch (const std::exception& error) {
        std::fprintf(stderr, "cathlab: internal error: %s\n", error.what());
    }
    return 1;
}
