// The subcommands.  Each add_* declares its options on the command line and what runs when it is chosen.
#pragma once

#include <string>
#include <vector>

#include "context.h"

namespace CLI {
class App;
}

namespace cathlab {

void add_run_command(CLI::App& app, AppContext& context);
/// `score`: metrics and score of recorded runs, recomputed.
void add_score_command(CLI::App& app, AppContext& context);
/// `study`: a user study from its protocol to its report.
void add_study_command(CLI::App& app, AppContext& context);
void add_replay_command(CLI::App& app, AppContext& context);
/// `render`: the pictures of a recorded run again, from elsewhere.
void add_render_command(CLI::App& app, AppContext& context);
/// `play`: the trainer's window.
void add_play_command(CLI::App& app, AppContext& context);
void add_list_command(CLI::App& app, AppContext& context);
void add_check_command(CLI::App& app, AppContext& context);
void add_calibrate_command(CLI::App& app, AppContext& context);
void add_explain_command(CLI::App& app, AppContext& context);
void add_bench_command(CLI::App& app, AppContext& context);
/// `bench wall`, below `bench`.
void add_bench_wall_command(CLI::App& bench);
/// `bench wire`, `bench contact` and `bench step`.
void add_bench_device_commands(CLI::App& bench, AppContext& context);
/// `bench fluoroscopy`.
void add_bench_fluoroscopy_command(CLI::App& bench, AppContext& context);

}  // namespace cathlab
