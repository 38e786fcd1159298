#include "scored_run.h"

#include <bit>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "core/errors.h"
#include "record/run_files.h"
#include "record/run_writer.h"
#include "record/sums.h"
#include "run_verifier.h"
#include "scene/toml_document.h"
#include "session.h"
#include "task_watch.h"

namespace cathlab {
namespace {

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
    if (read_text_file(path, most_log_bytes) != now) differences.push_back(path + " is not what the inputs say");
}

/// As result.json says; the rest of that file follows from the inputs.
OperatorName who_acted(const std::string& folder) {
    std::ifstream in(folder + "/result.json");
    const auto stored = nlohmann::ordered_json::parse(in, nullptr, false);
    OperatorName who;
    if (!in || !stored.is_object()) return who;
    const auto text = [&](const char* key) {
        const auto it = stored.find(key);
        return it != stored.end() && it->is_string() ? it->get<std::string>() : std::string();
    };
    who = {text("operator"), text("skill"), text("difficulty"), {}};
    if (const auto aids = stored.find("aids"); aids != stored.end() && aids->is_object())
        for (const auto& [name, seconds] : aids->items())
            if (seconds.is_number()) who.aids_s.emplace_back(name, seconds.get<double>());
    return who;
}

}  // namespace

ScoredRun score_run(const RunRecord& run, const SceneSpec& scene, const SceneModels* models, int threads,
                    const AppContext& context, const std::function<void(double)>& progress,
                    const std::function<void(std::int64_t, World&)>& each) {
    const std::string& folder = run.folder;
    ScoredRun out;
    out.folder = folder;
    out.differences = check_sums(folder);
    Session session = models ? Session(scene, *models, run.manifest.seed, threads)
                             : Session(scene, run.manifest.seed, threads, context);
    if (session.anatomy_hash() != run.manifest.anatomy_hash)
        throw UserError(folder + ": the anatomy is built otherwise than when this run was recorded");
    RunVerifier verifier(run);
    std::string events;
    TaskWatch watch(session.world(), task_of(scene));
    for (std::int64_t step = 0; step < run.steps; ++step) {
        if (stop_wanted()) throw UserError("stopped; nothing was written");
        verifier.state(step, session.world());
        session.step(run.input_at(step));
        verifier.channels(step, session.channels());
        watch.add(session.world(), session.channels(), session.dt());
        for (const Event& event : session.events()) events += event_line(event) + "\n";
        if (each) each(step, session.world());
        if (progress) progress(static_cast<double>(step + 1) / static_cast<double>(run.steps));
    }
    verifier.state(run.steps, session.world());
    if (!verifier.difference().empty())
        out.differences.push_back(folder + ": " + verifier.difference());
    else if (!verifier.channels_agree())
        out.differences.push_back(folder + ": " + verifier.channel_difference());
    out.metrics = watch.metrics();
    // Of a run that was broken off the last events may not have reached the disk.
    if (run.manifest.complete) compare_file(folder + "/events.jsonl", events, out.differences);
    compare_file(folder + "/result.json", watch.result_json(who_acted(folder)), out.differences);
    compare_file(folder + "/regions.csv", watch.forces().regions_csv(), out.differences);
    compare_file(folder + "/force-map.csv", force_map_csv(watch.forces().unrolled()), out.differences);
    out.task = watch.task();
    out.reached = watch.reached();
    out.score = watch.score();
    compare_metrics(folder, out.metrics, out.differences);
    return out;
}

}  // namespace cathlab
