// cathlab explain: from a recording to the effect that the model lacks.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <memory>

#include "calibrate_output.h"
#include "commands.h"
#include "core/errors.h"
#include "explain/report.h"
#include "explain/sensitivity.h"
#include "explain_output.h"
#include "progress.h"
#include "scene/load_scene.h"
#include "session.h"

namespace cathlab {
namespace {

struct ExplainRequest {
    std::string dataset, out, scene;
    bool sensitivity = false;
    ExplainOptions options;
};

/// Prints which effects such a recording could not tell apart.
void print_sensitivity(ExplainRequest request) {
    const Dataset data = read_dataset(request.dataset);
    catch_stop_signals();
    Progress progress("comparing");
    request.options.on_progress = [&](double part) {
        progress.update(part, "pairs of effects");
        return !stop_wanted();
    };
    const Sensitivity found = sensitivity(data, request.options);
    progress.end();
    std::printf(
        "Each effect made to do %g times the noise, with the inputs of this recording, and every other fitted to it.\n"
        "left: part of the held-out error that the other one leaves; below %g the two are not told apart.\n\n",
        found.response_over_noise, told_apart);
    std::printf("  %-20s %-20s %s\n", "acts", "is fitted", "left");
    constexpr std::size_t most = 20;
    for (std::size_t k = 0;
         k < std::min(most, found.pairs.size()) || (k < found.pairs.size() && found.pairs[k].left < told_apart); ++k)
        std::printf("  %-20s %-20s %.3f%s\n", found.pairs[k].acting.c_str(), found.pairs[k].fitted.c_str(),
                    found.pairs[k].left, found.pairs[k].left < told_apart ? "  not told apart" : "");
    for (const std::string& name : found.taken_up) std::printf("  %s: taken up by the base model\n", name.c_str());
    for (const std::string& name : found.too_weak) std::printf("  %s: too weak to be seen here\n", name.c_str());
}

void explain_dataset(ExplainRequest request, AppContext& context) {
    namespace fs = std::filesystem;
    using Clock = std::chrono::steady_clock;
    const Clock::time_point begin = Clock::now();
    if (!request.scene.empty())  // a scene that cannot be loaded is said before the work, not after it
        load_scene(find_scene(request.scene, context.data_root), {}, context.data_root);
    const Dataset data = read_dataset(request.dataset);
    if (request.out.empty()) {
        std::string name = fs::path(request.dataset).lexically_normal().filename().string();
        if (name.empty()) name = fs::path(request.dataset).lexically_normal().parent_path().filename().string();
        request.out = "explain-" + name;
    }
    const ExplainOutput output(request.out);

    catch_stop_signals();
    Progress progress("explaining");
    request.options.on_progress = [&](double part) {
        progress.update(part, "candidates");
        return !stop_wanted();
    };
    const Explanation found = explain(data, request.options);
    progress.end();
    const double seconds = std::chrono::duration<double>(Clock::now() - begin).count();

    for (const std::string& sentence : explain_sentences(data, found)) std::printf("%s\n", sentence.c_str());
    const Page page = explain_page(data, found, context.command_line);
    for (const PageTable& table : page.tables)
        if (table.caption != "Base model") std::printf("\n%s", table_text(table).c_str());
    output.write(data, found, request.options, seconds, context.command_line);
    if (!request.scene.empty() && !found.overlay.empty())
        load_scene(find_scene(request.scene, context.data_root),
                   {(fs::path(output.folder()) / "overlay.toml").string()}, context.data_root);
    std::printf("\nwritten: %s\n", output.folder().c_str());
    if (!found.overlay.empty())
        std::printf("to run with it: cathlab run %s --overlay %s/overlay.toml\n",
                    request.scene.empty() ? "SCENE" : request.scene.c_str(), output.folder().c_str());
}

}  // namespace

void add_explain_command(CLI::App& app, AppContext& context) {
    CLI::App* command = app.add_subcommand("explain", "Find the effect that the model lacks in a recording");
    const auto request = std::make_shared<ExplainRequest>();
    request->options.threads = default_threads();
    command->add_option("DATASET", request->dataset, "a folder with dataset.toml and data.csv")->required();
    command->add_option("--out", request->out,
                        "folder for result.json, report.html and overlay.toml; explain-NAME if not given");
    command->add_option("--scene", request->scene, "a scene that the overlay must fit; it is tried on it");
    command->add_option("--max-effects", request->options.max_effects, "at most so many are looked for")
        ->check(CLI::Range(0, 10))
        ->capture_default_str();
    command->add_option("--threads", request->options.threads, "fits at the same time; the result is the same")
        ->check(CLI::Range(1, 256))
        ->capture_default_str();
    command->add_option("--seed", request->options.seed, "of the permutations")
        ->check(CLI::Range(std::uint64_t{0}, std::uint64_t{9007199254740991}))
        ->capture_default_str();
    command->add_flag("--sensitivity", request->sensitivity,
                      "print which effects such a recording could not tell apart, and write nothing");
    command->callback([request, &context] {
        if (request->sensitivity)
            print_sensitivity(*request);
        else
            explain_dataset(*request, context);
    });
}

}  // namespace cathlab
