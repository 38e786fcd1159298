// cathlab score: the metrics of recorded runs again, from their inputs alone, without a picture.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "commands.h"
#include "progress.h"
#include "record/run_reader.h"
#include "recorded_scene.h"
#include "scored_run.h"
#include "session.h"

namespace cathlab {
namespace {

struct ScoreOptions {
    std::vector<std::string> folders;
    int threads = default_threads();
    bool json = false;
};

nlohmann::ordered_json json_of(const ScoredRun& run) {
    nlohmann::ordered_json out{{"folder", run.folder}};
    if (run.task) {
        out["task"] = run.task->name;
        out["reached"] = run.reached;
        out["score"] = run.score;
        out["passed"] = run.reached && run.score >= run.task->pass_score;
    }
    for (const MetricInfo& metric : metric_table())
        out["metrics"][std::string(metric.name)] = run.metrics.*metric.value;
    out["differences"] = run.differences;
    return out;
}

void print(const ScoredRun& run) {
    std::printf("%s\n", run.folder.c_str());
    if (run.task)
        std::printf("  task %s: %s, score %.1f of 100 (%.0f passes)\n", run.task->name.c_str(),
                    run.reached ? "reached" : "not reached", run.score, run.task->pass_score);
    for (const MetricInfo& metric : metric_table())
        std::printf("  %-30.*s %14.6g %.*s\n", static_cast<int>(metric.name.size()), metric.name.data(),
                    run.metrics.*metric.value, static_cast<int>(metric.unit.size()), metric.unit.data());
    for (const std::string& difference : run.differences) std::printf("  DIFFERS: %s\n", difference.c_str());
    if (run.differences.empty()) std::printf("  every file, channel, hash and metric is what the inputs give\n");
}

void score_runs(const ScoreOptions& options, AppContext& context) {
    nlohmann::ordered_json all = nlohmann::ordered_json::array();
    for (const std::string& folder : options.folders) {
        const RunRecord record = read_run(folder);
        Progress progress("scoring");
        const ScoredRun run = score_run(record, recorded_scene(record, context), nullptr, options.threads, context,
                                        [&](double done) { progress.update(done, folder); });
        progress.end();
        if (!run.differences.empty()) context.exit_code = 1;
        if (options.json)
            all.push_back(json_of(run));
        else
            print(run);
    }
    if (options.json) std::printf("%s\n", all.dump(2).c_str());
}

}  // namespace

void add_score_command(CLI::App& app, AppContext& context) {
    const auto options = std::make_shared<ScoreOptions>();
    CLI::App* command = app.add_subcommand(
        "score", "The metrics of recorded runs again, from their inputs alone; exit code 1 where anything differs");
    command->add_option("DIR", options->folders, "run folders")->required();
    command->add_option("--threads", options->threads, "of the step; they change no bit")
        ->check(CLI::Range(1, 256))
        ->capture_default_str();
    command->add_flag("--json", options->json, "As JSON");
    command->callback([options, &context] { score_runs(*options, context); });
}

}  // namespace cathlab
