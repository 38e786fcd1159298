// cathlab bench: milliseconds a step by room, and a picture.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <map>
#include <nlohmann/json.hpp>

#include "commands.h"
#include "film.h"
#include "progress.h"
#include "run_options.h"
#include "scene/load_scene.h"
#include "scene/script.h"
#include "session.h"
#include "world/step_settings.h"

namespace cathlab {
namespace {

struct BenchOptions {
    std::string scene = "demo";
    double seconds = 10.0;
    int threads = 1;
    bool json = false;
    bool pictures = true;
};

using Clock = std::chrono::steady_clock;

double ms_between(Clock::time_point a, Clock::time_point b) {
    return std::chrono::duration<double, std::milli>(b - a).count();
}

// Adds up the time between one stage's begin and the next's, a step (or a picture) at a time.
class StageTimes {
public:
    void begin(std::string_view room) {
        const auto now = Clock::now();
        if (!room_.empty()) step_[room_] += ms_between(since_, now);
        room_ = std::string(room);
        since_ = now;
    }
    void end_step(double whole_ms) {
        begin("");
        double known = 0.0;
        for (const auto& [room, ms] : step_) {
            times_[room].push_back(ms);
            known += ms;
        }
        times_["(between)"].push_back(std::max(0.0, whole_ms - known));
        times_["step"].push_back(whole_ms);
        step_.clear();
    }
    const std::map<std::string, std::vector<double>>& times() const { return times_; }

private:
    std::string room_;
    Clock::time_point since_;
    std::map<std::string, double> step_;
    std::map<std::string, std::vector<double>> times_;
};

struct Row {
    std::string name;
    double mean = 0.0, median = 0.0, p99 = 0.0;
    std::size_t count = 0;
};

Row row_of(const std::string& name, std::vector<double> ms) {
    std::sort(ms.begin(), ms.end());
    Row row{name, 0.0, ms[ms.size() / 2], ms[std::min(ms.size() - 1, ms.size() * 99 / 100)], ms.size()};
    for (const double v : ms) row.mean += v / static_cast<double>(ms.size());
    return row;
}

void print(const std::vector<Row>& rows, const BenchOptions& options, const SceneSpec& scene, double real_time) {
    if (options.json) {
        nlohmann::ordered_json out{{"scene", scene.name},
                                   {"threads", options.threads},
                                   {"dt_ms", 1000.0 * scene.step.dt_s},
                                   {"real_time_factor", real_time}};
        for (const Row& row : rows)
            out["ms"][row.name] = {{"mean", row.mean}, {"median", row.median}, {"p99", row.p99}, {"count", row.count}};
        std::printf("%s\n", out.dump(2).c_str());
        return;
    }
    std::printf("%s, %d thread%s, cluster fits in %s, step of %g ms\n", scene.name.c_str(), options.threads,
                options.threads == 1 ? "" : "s", scene.wall.precision.c_str(), 1000.0 * scene.step.dt_s);
    std::printf("%-22s %10s %10s %10s\n", "room", "mean ms", "median", "p99");
    for (const Row& row : rows)
        std::printf("%-22s %10.3f %10.3f %10.3f\n", row.name.c_str(), row.mean, row.median, row.p99);
    std::printf("physics at %.2f x real time\n", real_time);
}

void bench(const BenchOptions& options, const AppContext& context) {
    require_finite("--seconds", options.seconds);
    const SceneSpec scene = load_scene(find_scene(options.scene, context.data_root), {}, context.data_root);
    const Script script = scene.script.empty() ? Script() : Script::load(scene.script);
    Session session(scene, scene.seed, options.threads, context);
    StageTimes times, parts;
    World& world = session.world();
    world.add(*world.find(world_entity), StageProbe{[&](std::string_view room) { times.begin(room); }});
    std::unique_ptr<Film> film;
    if (options.pictures)
        film = std::make_unique<Film>(scene,
                                      FilmOptions{"", scene.video.width, scene.video.height, scene.video.fps,
                                                  [&](std::string_view part) { parts.begin(part); }},
                                      0);
    Progress progress("benchmark");
    const Input base = session.base_input();
    const auto steps = std::max<std::int64_t>(1, std::llround(options.seconds / session.dt()));
    for (std::int64_t k = 0; k < steps && !stop_wanted(); ++k) {
        const Input input = script.at(static_cast<double>(k) * session.dt(), base);
        const auto begin = Clock::now();
        session.step(input);
        times.end_step(ms_between(begin, Clock::now()));
        if (film && film->due(session.channels().time_s)) {
            const auto drawing = Clock::now();
            film->add(world, session.channels());
            parts.end_step(ms_between(drawing, Clock::now()));
        }
        progress.update(static_cast<double>(k + 1) / static_cast<double>(steps));
    }
    progress.end();
    if (times.times().empty()) return;
    std::vector<Row> rows;
    for (const auto& [name, ms] : times.times())
        if (name != "step") rows.push_back(row_of(name, ms));
    rows.push_back(row_of("step", times.times().at("step")));
    const double real_time = 1000.0 * session.dt() / rows.back().mean;
    for (const auto& [name, ms] : parts.times())
        if (name != "step") rows.push_back(row_of("picture: " + name, ms));
    if (parts.times().contains("step")) rows.push_back(row_of("picture", parts.times().at("step")));
    print(rows, options, scene, real_time);
}

}  // namespace

void add_bench_command(CLI::App& app, AppContext& context) {
    const auto options = std::make_shared<BenchOptions>();
    CLI::App* command = app.add_subcommand("bench", "Measure milliseconds a step by room, or one room beside a peer");
    command->add_option("SCENE", options->scene, "a scene file, or the name of one in scenes/")->capture_default_str();
    command->add_option("--seconds", options->seconds, "simulated time")
        ->check(CLI::Range(0.02, 3600.0))
        ->capture_default_str();
    command->add_option("--threads", options->threads, "for the step; a picture is drawn on one")
        ->check(CLI::Range(1, 256))
        ->capture_default_str();
    command->add_flag("--json", options->json, "As JSON");
    command->add_flag("!--no-pictures", options->pictures, "leave the pictures out");
    add_bench_wall_command(*command);
    add_bench_device_commands(*command, context);
    add_bench_fluoroscopy_command(*command, context);
    command->callback([options, command, &context] {
        if (command->get_subcommands().empty()) bench(*options, context);
    });
}

}  // namespace cathlab
