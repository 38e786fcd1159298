// cathlab explain: from a recording to the effect that the model lacks.
#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <memory>

#include "calibrate_output.h"
#include "commands.h"
#include "core/errors.h"
#include "explain/report.h"
#include "explain_output.h"
#include "progress.h"
#include "scene/load_scene.h"
#include "session.h"

namespace cathlab {
namespace {

struct ExplainRequest {
    std::string dataset, out, scene;
    ExplainOptions options;
};

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
    command->callback([request, &context] { explain_dataset(*request, context); });
}

}  // namespace cathlab
