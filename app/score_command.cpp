// cathlab score: the metrics of recorded runs again, from their inputs alone, without a picture.
#include <CLI/CLI.hpp>
#include <bit>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "commands.h"
#include "core/errors.h"
#include "progress.h"
#include "record/sums.h"
#include "recorded_scene.h"
#include "run_verifier.h"
#include "scene/toml_document.h"
#include "session.h"
#include "task_watch.h"

namespace cathlab {
namespace {

struct ScoreOptions {
    std::vector<std::string> folders;
    int threads = default_threads();
    bool json = false;
};

struct Scored {
    std::string folder;
    Metrics metrics;
    std::optional<TaskSpec> task;
    bool reached = false;
    double score = 0.0;
    std::vector<std::string> differences;  // from what is stored
};

bool same_bits(double a, double b) {
    return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}

void compare_metrics(const std::string& folder, const Metrics& now, std::vector<std::string>& differences) {
    const std::string path = folder + "/metrics.json";
    std::ifstream in(path);
    const auto stored = nlohmann::json::parse(in, nullptr, false);
    if (!in || !stored.is_object()) {
        differences.push_back(path + " is missing or no JSON object");
        return;
    }
    for (const MetricInfo& metric : metric_table()) {
        const auto it = stored.find(std::string(metric.name));
        if (it == stored.end() || !it->is_number())
            differences.push_back(path + " lacks " + std::string(metric.name));
        else if (!same_bits(it->get<double>(), now.*metric.value))
            differences.push_back(path + ": " + std::string(metric.name) + " is " + it->dump() + " there and " +
                                  nlohmann::json(now.*metric.value).dump() + " by the inputs");
    }
}

/// What the inputs say of a file that a run may have; a run of the trainer has none of the forces' tables.
void compare_file(const std::string& path, const std::string& now, std::vector<std::string>& differences) {
    if (!std::filesystem::exists(path)) return;
    if (read_text_file(path, 1U << 24U) != now) differences.push_back(path + " is not what the inputs say");
}

/// The recorded inputs once more, with every channel and hash compared on the way.
Scored score_run(const std::string& folder, int threads, const AppContext& context) {
    Scored out;
    out.folder = folder;
    out.differences = check_sums(folder);
    const RunRecord run = read_run(folder);
    const SceneSpec scene = recorded_scene(run, context);
    Session session(scene, run.manifest.seed, threads, context);
    if (session.anatomy_hash() != run.manifest.anatomy_hash)
        throw UserError(folder + ": the anatomy is built otherwise than when this run was recorded");
    RunVerifier verifier(run);
    TaskWatch watch(session.world(), task_of(scene));
    Progress progress("scoring");
    for (std::int64_t step = 0; step < run.steps; ++step) {
        if (stop_wanted()) throw UserError("stopped; nothing was written");
        verifier.state(step, session.world());
        session.step(run.input_at(step));
        verifier.channels(step, session.channels());
        watch.add(session.world(), session.channels(), session.dt());
        progress.update(static_cast<double>(step + 1) / static_cast<double>(run.steps), folder);
    }
    verifier.state(run.steps, session.world());
    progress.end();
    if (!verifier.difference().empty())
        out.differences.push_back(folder + ": " + verifier.difference());
    else if (!verifier.channels_agree())
        out.differences.push_back(folder + ": " + verifier.channel_difference());
    out.metrics = watch.metrics();
    compare_file(folder + "/regions.csv", watch.forces().regions_csv(), out.differences);
    compare_file(folder + "/force-map.csv", force_map_csv(watch.forces().unrolled()), out.differences);
    out.task = watch.task();
    out.reached = watch.reached();
    out.score = watch.score();
    compare_metrics(folder, out.metrics, out.differences);
    return out;
}

nlohmann::ordered_json json_of(const Scored& run) {
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

void print(const Scored& run) {
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
        const Scored run = score_run(folder, options.threads, context);
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
